#define VOXRT_RENDER_TILE render_tile_portable
#include "frame_tile_body.h"
