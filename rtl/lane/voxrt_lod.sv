// Level of detail: tells which rays stop at the cell of a pointer and show its mean material. Far cells are smaller
// than a pixel, and their words need not be read. These are stages 2 to 5 of voxrt_lane.
//
// A ray stops at a cell of 2**level voxels per side where the cell is at a distance of reach * 2**level or more: the
// greatest along an axis from the ray's origin to the cell's near plane, voxels, rounded down. docs/lod.md says why.
module voxrt_lod
  import voxrt_pkg::*;
#(
  parameter int unsigned LevelBits = 4,  // 1 or more.
  parameter int unsigned WholeBits = 14  // Bits of a distance in voxels, signed: 2 .. ReachLimit.
) (
  input  logic                        clk_i,
  // Stage 2: a ray reads a pointer with that mean material; 0: the cell is not to be stopped at.
  input  logic                        pointer_i,
  input  material_t                   mean_i,
  input  logic signed [WholeBits-1:0] near_i   [3],
  input  logic        [LevelBits-1:0] level_i,
  // Stage 3.
  input  logic        [WholeBits-1:0] reach_i,
  // Stage 5.
  output logic                        stops_o,
  output material_t                   mean_o
);
  if (LevelBits < 1) $error("voxrt_lod: LevelBits must be 1 bit or more");
  if (WholeBits < 2 || WholeBits > ReachLimit) $error("voxrt_lod: WholeBits must be 2 to ReachLimit bits");

  // 2: the farthest near plane. The cell of the origin has none ahead: its distance counts as 0.
  logic signed [WholeBits-1:0] farther, farthest;
  logic [WholeBits-2:0] distance3_q;
  logic [LevelBits-1:0] level3_q;
  logic pointer3_q;
  material_t mean3_q;

  assign farther  = near_i[0] > near_i[1] ? near_i[0] : near_i[1];
  assign farthest = farther > near_i[2] ? farther : near_i[2];

  always_ff @(posedge clk_i) begin
    distance3_q <= farthest < 0 ? '0 : farthest[WholeBits-2:0];
    level3_q    <= level_i;
    pointer3_q  <= pointer_i;
    mean3_q     <= mean_i;
  end

  // 3: distance and reach of a voxel.
  logic [WholeBits-2:0] distance4_q;
  logic [WholeBits-1:0] reach4_q;
  logic pointer4_q;
  material_t mean4_q;

  always_ff @(posedge clk_i) begin
    distance4_q <= distance3_q >> level3_q;
    reach4_q    <= reach_i;
    pointer4_q  <= pointer3_q && mean3_q != '0;
    mean4_q     <= mean3_q;
  end

  // 4: compare.
  logic stops5_q;
  material_t mean5_q;

  always_ff @(posedge clk_i) begin
    stops5_q <= pointer4_q && {1'b0, distance4_q} >= reach4_q;
    mean5_q  <= mean4_q;
  end

  assign stops_o = stops5_q;
  assign mean_o  = mean5_q;
endmodule
