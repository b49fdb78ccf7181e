#define VOXRT_OPEN_RAYS open_rays_avx512
#include "parallel_rays_body.h"
