#define VOXRT_SWEEP sweep_portable
#include "sweep_body.h"
