#define VOXRT_SWEEP sweep_avx512
#include "sweep_body.h"
