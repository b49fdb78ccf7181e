#define VOXRT_OPEN_RAYS open_rays_avx2
#include "parallel_rays_body.h"
