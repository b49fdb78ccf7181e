#define VOXRT_COVER_BY_VECTORS cover_by_vectors_avx2
#include "vector_coverage_body.h"
