// The mirrors of a lane: tells which hits are reflected, and sums the colours of the mirrors that a ray has met.
//
// A ray that has been reflected as often as the frame allows shows the mean of its mirrors. So their sum and count are
// kept per slot, and the lane has a copy of the material table of its own: one lookup per hit, in half a block RAM, at
// the lane's own pace. (One table for all lanes would need a queue, and a slot that waits.)
module voxrt_reflect
  import voxrt_pkg::*;
#(
  parameter int unsigned Slots = 12  // Rays in the ring of the lane (lane_slots): 12 .. 15.
) (
  input  logic                                clk_i,
  // Held during a frame; 0: no material is a mirror.
  input  logic            [   BounceBits-1:0] bounces_i,
  input  material_write_t                     material_write_i,
  // Stage 3 of the lane: the material of the word read. Stage 7: its slot.
  input  material_t                           material_i,
  input  logic            [$clog2(Slots)-1:0] slot7_i,
  // Stage 9: the ray of the slot hits the material, in a face; or a new ray is issued to the slot.
  input  logic            [$clog2(Slots)-1:0] slot9_i,
  input  logic                                hit_i,
  input  logic                                issues_i,
  output logic                                reflects_o,        // The ray is reflected.
  output logic                                ends_o,            // It was reflected often enough: it shows mirrors_o.
  output mirrors_t                            mirrors_o
);
  if (Slots < 12 || Slots > 15) $error("voxrt_reflect: Slots must be 12 to 15");

  material_entry_t table_q[256];
  material_entry_t entry4_q, entry5_q, entry6_q, entry7_q;
  mirrors_t mirrors_q[Slots], mirrors7, mirrors8_q, mirrors9_q;
  logic mirror8_q, mirror9_q, last9_q;

  assign mirrors7 = mirrors_q[slot7_i];

  always_ff @(posedge clk_i) begin
    if (material_write_i.valid) table_q[material_write_i.material] <= material_write_i.entry;
    entry4_q            <= table_q[material_i];
    entry5_q            <= entry4_q;
    entry6_q            <= entry5_q;
    entry7_q            <= entry6_q;
    mirror8_q           <= entry7_q.mirror && bounces_i != '0;
    mirrors8_q.count    <= mirrors7.count + 1'b1;
    mirrors8_q.total[0] <= mirrors7.total[0] + ColourSumBits'(entry7_q.colour.red);
    mirrors8_q.total[1] <= mirrors7.total[1] + ColourSumBits'(entry7_q.colour.green);
    mirrors8_q.total[2] <= mirrors7.total[2] + ColourSumBits'(entry7_q.colour.blue);
    mirror9_q           <= mirror8_q;
    last9_q             <= mirrors8_q.count[BounceBits-1:0] == bounces_i + 1'b1;
    mirrors9_q          <= mirrors8_q;
    if (issues_i || reflects_o) mirrors_q[slot9_i] <= issues_i ? '0 : mirrors9_q;
  end

  assign reflects_o = hit_i && mirror9_q && !last9_q;
  assign ends_o     = hit_i && mirror9_q && last9_q;
  assign mirrors_o  = mirrors9_q;
endmodule
