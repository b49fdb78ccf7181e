// Mirrors, for one lane: which hits are reflected, and the colours met on a ray's way.
//
// A ray that has been reflected as often as the frame allows shows the mean of the mirrors it met. So their sum and
// count are kept by slot, and the lane has a copy of the material table of its own: a lookup for each hit, in half a
// block RAM, at the lane's own pace. (One table for all lanes would need a queue before it, and a turn to wait for.)
module voxrt_reflect
  import voxrt_pkg::*;
#(
  parameter  int unsigned Slots    = 8,
  localparam int unsigned SlotBits = $clog2(Slots)
) (
  input  logic                  clk_i,
  // Held during a frame; 0: no material is a mirror.
  input  logic [BounceBits-1:0] bounces_i,
  input  logic                  table_write_i,
  input  material_t             table_material_i,
  input  row_t                  table_row_i,
  // Stage 3 of the lane: the material of the word read. Stage 5: whose it is.
  input  material_t             material_i,
  input  logic [  SlotBits-1:0] slot5_i,
  // Stage 7: the material was hit, in a face; or a ray starts in its place.
  input  logic [  SlotBits-1:0] slot7_i,
  input  logic                  hit_i,
  input  logic                  starts_i,
  output logic                  reflects_o,  // The ray goes on.
  output logic                  ends_o,      // It has been reflected often enough: met_o is what it shows.
  output mirrors_t              met_o
);
  row_t     table_q[256];
  row_t     row4_q, row5_q;
  mirrors_t met_q[Slots], met5, met6_q, met7_q;
  logic     mirror6_q, mirror7_q, last7_q;

  assign met5 = met_q[slot5_i];

  always_ff @(posedge clk_i) begin
    if (table_write_i) table_q[table_material_i] <= table_row_i;
    row4_q       <= table_q[material_i];
    row5_q       <= row4_q;
    mirror6_q    <= row5_q.mirror && bounces_i != '0;
    met6_q.count <= met5.count + 1'b1;
    met6_q.sum   <= {met5.sum[2] + ColourSumBits'(row5_q.colour.blue), met5.sum[1] + ColourSumBits'(row5_q.colour.green),
                     met5.sum[0] + ColourSumBits'(row5_q.colour.red)};
    mirror7_q    <= mirror6_q;
    last7_q      <= met6_q.count[BounceBits-1:0] == bounces_i + 1'b1;
    met7_q       <= met6_q;
    if (starts_i || reflects_o) met_q[slot7_i] <= starts_i ? '0 : met7_q;
  end

  assign reflects_o = hit_i && mirror7_q && !last7_q;
  assign ends_o     = hit_i && mirror7_q && last7_q;
  assign met_o      = met7_q;
endmodule
