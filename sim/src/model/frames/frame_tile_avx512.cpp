#define VOXRT_RENDER_TILE render_tile_avx512
#include "frame_tile_body.h"
