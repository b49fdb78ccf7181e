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
  // Stage 3 of the lane: the material of the word read. Stage 6: whose it is.
  input  material_t             material_i,
  input  logic [  SlotBits-1:0] slot6_i,
  // Stage 8: the material was hit, in a face; or a ray starts in its place.
  input  logic [  SlotBits-1:0] slot8_i,
  input  logic                  hit_i,
  input  logic                  starts_i,
  output logic                  reflects_o,  // The ray goes on.
  output logic                  ends_o,      // It has been reflected often enough: met_o is what it shows.
  output mirrors_t              met_o
);
  row_t     table_q[256];
  row_t     row4_q, row5_q, row6_q;
  mirrors_t met_q[Slots], met6, met7_q, met8_q;
  logic     mirror7_q, mirror8_q, last8_q;

  assign met6 = met_q[slot6_i];

  always_ff @(posedge clk_i) begin
    if (table_write_i) table_q[table_material_i] <= table_row_i;
    row4_q        <= table_q[material_i];
    row5_q        <= row4_q;
    row6_q        <= row5_q;
    mirror7_q     <= row6_q.mirror && bounces_i != '0;
    met7_q.count  <= met6.count + 1'b1;
    met7_q.sum[0] <= met6.sum[0] + ColourSumBits'(row6_q.colour.red);
    met7_q.sum[1] <= met6.sum[1] + ColourSumBits'(row6_q.colour.green);
    met7_q.sum[2] <= met6.sum[2] + ColourSumBits'(row6_q.colour.blue);
    mirror8_q     <= mirror7_q;
    last8_q       <= met7_q.count[BounceBits-1:0] == bounces_i + 1'b1;
    met8_q        <= met7_q;
    if (starts_i || reflects_o) met_q[slot8_i] <= starts_i ? '0 : met8_q;
  end

  assign reflects_o = hit_i && mirror8_q && !last8_q;
  assign ends_o     = hit_i && mirror8_q && last8_q;
  assign met_o      = met8_q;
endmodule
