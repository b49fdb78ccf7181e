#define VOXRT_COVERAGE kPortableCoverage
#define VOXRT_INSTRUCTIONS "portable"
#include "vector_coverage_body.h"
