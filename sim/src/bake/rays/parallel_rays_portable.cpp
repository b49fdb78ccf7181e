#define VOXRT_OPEN_RAYS open_rays_portable
#include "parallel_rays_body.h"
