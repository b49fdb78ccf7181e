#define VOXRT_RENDER_TILE render_tile_avx2
#include "frame_tile_body.h"
