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
  // Stage 3 of the lane: the material of the word read. Stage 7: whose it is.
  input  material_t             material_i,
  input  logic [  SlotBits-1:0] slot7_i,
  // Stage 9: the material was hit, in a face; or a ray starts in its place.
  input  logic [  SlotBits-1:0] slot9_i,
  input  logic                  hit_i,
  input  logic                  starts_i,
  output logic                  reflects_o,  // The ray goes on.
  output logic                  ends_o,      // It has been reflected often enough: met_o is what it shows.
  output mirrors_t              met_o
);
  row_t     table_q[256];
  row_t     row4_q, row5_q, row6_q, row7_q;
  mirrors_t met_q[Slots], met7, met8_q, met9_q;
  logic     mirror8_q, mirror9_q, last9_q;

  assign met7 = met_q[slot7_i];

  always_ff @(posedge clk_i) begin
    if (table_write_i) table_q[table_material_i] <= table_row_i;
    row4_q        <= table_q[material_i];
    row5_q        <= row4_q;
    row6_q        <= row5_q;
    row7_q        <= row6_q;
    mirror8_q     <= row7_q.mirror && bounces_i != '0;
    met8_q.count  <= met7.count + 1'b1;
    met8_q.sum[0] <= met7.sum[0] + ColourSumBits'(row7_q.colour.red);
    met8_q.sum[1] <= met7.sum[1] + ColourSumBits'(row7_q.colour.green);
    met8_q.sum[2] <= met7.sum[2] + ColourSumBits'(row7_q.colour.blue);
    mirror9_q     <= mirror8_q;
    last9_q       <= met8_q.count[BounceBits-1:0] == bounces_i + 1'b1;
    met9_q        <= met8_q;
    if (starts_i || reflects_o) met_q[slot9_i] <= starts_i ? '0 : met9_q;
  end

  assign reflects_o = hit_i && mirror9_q && !last9_q;
  assign ends_o     = hit_i && mirror9_q && last9_q;
  assign met_o      = met9_q;
endmodule
