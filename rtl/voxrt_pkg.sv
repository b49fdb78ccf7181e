// Types and numbers that every module of the ray tracer shares.
//
// Frames: grid axes, x = 0, y = 1, z = 2. Positions count 1/16 voxel. A ray is traced in the mirrored grid, in which
// all components of its direction are >= 0.
package voxrt_pkg;

  // 1/16 voxel.
  localparam int unsigned FractionBits = 4;
  // Size of the camera's look, right and up.
  localparam int unsigned CameraBits = 16;
  // Image sizes are 1 .. 2**SizeBits - 1.
  localparam int unsigned SizeBits = 12;
  // look + right * (column - W/2) + up * (H/2 - row), for any registers.
  localparam int unsigned ScanBits = CameraBits + SizeBits + 1;
  // Components of a direction are refused from 2**DirectionBits on.
  localparam int unsigned DirectionBits = 20;
  // Weights: a product of two components.
  localparam int unsigned WeightBits = 2 * DirectionBits;

  // The wider side of the part's multipliers: 25 for the DSP48 of 7-series parts, 18 for most others.
`ifdef VOXRT_NARROW_MULTIPLIERS
  localparam int unsigned MultiplierBits = 18;
`else
  localparam int unsigned MultiplierBits = 25;
`endif

  typedef logic [7:0] material_t;

  // The axis of a plane; FaceNone where none was crossed. The order of the codes is the order of planes that are
  // crossed at the same time.
  typedef enum logic [1:0] {
    FaceX    = 2'd0,
    FaceY    = 2'd1,
    FaceZ    = 2'd2,
    FaceNone = 2'd3
  } face_e;

  typedef struct packed {
    material_t material;
    face_e     face;
  } pixel_t;

  typedef struct packed {
    logic [7:0] red;
    logic [7:0] green;
    logic [7:0] blue;
  } colour_t;

  // Why a pixel may be wrong; sticky in the registers.
  typedef struct packed {
    // A direction component of 2**20 or more: the ray was not traced.
    logic direction_overflow;
    // A pointer that leads out of the memory or into the middle of a block.
    logic bad_pointer;
    // A pointer below the deepest level: the memory is cyclic, or deeper than the depth register says. Every pointer
    // read goes a level down and every leaf read goes ahead, so this is the only way a ray could run for ever.
    logic step_limit;
  } error_t;

  // T = (plane - origin) * weight needs the distance of any plane of the world from any position.
  function automatic int unsigned distance_bits(int unsigned max_depth, int unsigned position_bits);
    int unsigned world_bits = max_depth + FractionBits + 1;
    return (position_bits > world_bits ? position_bits : world_bits) + 1;
  endfunction

  // T as lanes compare it: modulo more than twice the time between any two planes of the world that a ray crosses in it.
  function automatic int unsigned key_bits(int unsigned max_depth);
    return WeightBits + max_depth + FractionBits + 1;
  endfunction

  // Memory words as the lanes read them: bit PayloadBits set = leaf of material [7:0], error in [8]; clear = block.
  function automatic int unsigned payload_bits(int unsigned block_bits);
    return block_bits > 9 ? block_bits : 9;
  endfunction

  // From an octree address to its word.
  function automatic int unsigned memory_clocks(bit banked);
    return banked ? 5 : 2;
  endfunction

endpackage
