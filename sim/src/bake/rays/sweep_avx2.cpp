#define VOXRT_SWEEP sweep_avx2
#include "sweep_body.h"
