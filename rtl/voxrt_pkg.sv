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

  // What the narrower side of a DSP48 takes of a number without sign.
  localparam int unsigned MultiplierSide = 17;

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

  // What a ray does with the word of its cell.
  typedef enum logic [1:0] {
    Retry,    // No word came.
    Descend,  // Into the block of a pointer.
    Leave,    // An empty leaf, through one of its faces.
    Finish    // The ray has ended: hit or error.
  } action_e;

  typedef struct packed {
    logic [7:0] red;
    logic [7:0] green;
    logic [7:0] blue;
  } colour_t;

  // A row of the material table.
  typedef struct packed {
    logic    mirror;
    colour_t colour;
  } row_t;

  // Shading, beyond the angle that the ray meets the face in: docs/shading.md.

  // Shadow rays count positions in 1/32 voxel.
  localparam int unsigned LitFractionBits = FractionBits + 1;
  // Reflections are at most 2**BounceBits - 1.
  localparam int unsigned BounceBits = 4;

  // The shader's features that a frame uses.
  typedef struct packed {
    logic                  flat;
    logic                  light;
    logic [7:0]            ambient;  // 1/256
    logic [BounceBits-1:0] bounces;  // 0: mirrors are like all others.
  } shading_t;

  // What a pixel's colour is made of; its detail in the pixel buffer is a payload below this.
  typedef enum logic [1:0] {
    ShadeAngle,  // The material, by the ray's own angle.
    ShadeMean,   // The mean of mirrors met: a mirrors_t.
    ShadeLight   // The material, by the light's angle or in shadow: {mirrored, place[2], place[1], place[0]}.
  } shade_e;

  // Sums of colours, and of how many.
  localparam int unsigned ColourSumBits = 8 + BounceBits;
  typedef struct packed {
    logic [2:0][ColourSumBits-1:0] sum;  // Red is 0.
    logic [BounceBits:0]           count;
  } mirrors_t;

  // What the shader shall take in the place of colour * (d_a**2 / |d|**2): sum * part / whole.
  localparam int unsigned SquareBits = 2 * DirectionBits;
  typedef struct packed {
    logic                          part_given;  // part / whole stand here.
    logic                          sum_given;   // The sums of colours too.
    logic [SquareBits-1:0]         part;
    logic [SquareBits+1:0]         whole;
    logic [2:0][ColourSumBits-1:0] sum;
  } brightness_t;

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

  // The same where each reflection moves the origin by less than the world's side.
  function automatic int unsigned reflected_distance_bits(int unsigned max_depth, int unsigned position_bits);
    int unsigned reach = 2 ** (position_bits - 1) + (2 ** BounceBits + 1) * 2 ** (max_depth + FractionBits);
    return $clog2(reach + 1) + 1;
  endfunction

  // T as lanes compare it: modulo more than twice the time between any two planes of the world that a ray crosses in it.
  function automatic int unsigned key_bits(int unsigned max_depth, bit light);
    return WeightBits + max_depth + (light ? LitFractionBits : FractionBits) + 1;
  endfunction

  // The light, in 1/16 voxel, signed: farther ones are farther than 2**DirectionBits from all of the world.
  function automatic int unsigned light_bits(int unsigned max_depth);
    return (max_depth + FractionBits >= DirectionBits ? max_depth + FractionBits + 1 : DirectionBits) + 1;
  endfunction

  // A pixel between lane and shader: its detail, {shade, payload}, and a pixel_t below it; or the pixel_t alone.
  function automatic int unsigned pixel_bits(int unsigned max_depth, bit light, bit mirrors);
    return (light || mirrors ? detail_bits(max_depth, light, mirrors) : 0) + $bits(pixel_t);
  endfunction

  function automatic int unsigned detail_bits(int unsigned max_depth, bit light, bit mirrors);
    int unsigned light_payload = light ? 3 + 3 * (max_depth + FractionBits) : 0;
    int unsigned mirrors_payload = mirrors ? $bits(mirrors_t) : 0;
    int unsigned payload = light_payload > mirrors_payload ? light_payload : mirrors_payload;
    return $bits(shade_e) + (payload == 0 ? 1 : payload);
  endfunction

  // Memory words as the lanes read them: bit PayloadBits set = leaf of material [7:0], error in [8]; clear = block.
  function automatic int unsigned payload_bits(int unsigned block_bits);
    return block_bits > 9 ? block_bits : 9;
  endfunction

  // From an octree address to its word.
  function automatic int unsigned memory_clocks(bit banked);
    return banked ? 5 : 2;
  endfunction

  // Rays that go round in a lane.
  function automatic int unsigned lane_slots(int unsigned clocks);
    return 10 + clocks;
  endfunction

  // Bits of the number of a row: a lane's rays and those that wait for it have one each.
  function automatic int unsigned row_bits(bit light);
    return light ? 6 : 5;
  endfunction

endpackage
