#define VOXRT_COVERAGE kAvx512Coverage
#define VOXRT_INSTRUCTIONS "avx512"
#include "vector_coverage_body.h"
