#define VOXRT_COVERAGE kAvx2Coverage
#define VOXRT_INSTRUCTIONS "avx2"
#include "vector_coverage_body.h"
