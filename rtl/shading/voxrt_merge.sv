// Merges the pixels of all lanes into one stream in pixel order. Lane i has the pixels i mod Lanes, and gives them in
// order: so a counter that goes round is enough to choose, and no pixel carries its number.
//
// Use it where streams were dealt out in turn and each has kept its order.
`include "voxrt_assert.svh"

module voxrt_merge #(
  parameter int unsigned Lanes = 1,
  parameter int unsigned Width = 8   // Bits: 1 or more.
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             start_i,         // The next pixel is lane 0's.
  input  logic [Lanes-1:0] valid_i,
  output logic [Lanes-1:0] ready_o,
  input  logic [Width-1:0] pixel_i[Lanes],
  output logic             valid_o,
  input  logic             ready_i,
  output logic [Width-1:0] pixel_o
);
  if (Width < 1) $error("voxrt_merge: Width must be 1 bit or more");

  logic [Lanes-1:0] next_lane_q;  // One-hot.
  logic valid;
  logic [Width-1:0] pixel;

  always_comb begin
    pixel = '0;
    for (int unsigned i = 0; i < Lanes; i++) if (next_lane_q[i]) pixel |= pixel_i[i];
  end

  assign valid   = (valid_i & next_lane_q) != '0;
  assign valid_o = valid;
  assign pixel_o = pixel;
  assign ready_o = ready_i ? next_lane_q : '0;

  always_ff @(posedge clk_i) begin
    if (valid && ready_i) next_lane_q <= Lanes'({next_lane_q, next_lane_q[Lanes-1]});
    if (!rst_ni || start_i) next_lane_q <= Lanes'(1);
  end

  `VOXRT_ASSERT(NextLaneIsOneHot, $onehot(next_lane_q))
endmodule
