// The queue of a lane with light: rays of the camera, and shadow rays, which leave first. Shadow rays must pass the
// others, or rays would wait for each other in a circle.
//
// Both queues are halves of one memory, because a distributed memory is deep enough for both. A ray comes only when its
// queue has a place: the writers hold credits, so none is refused.
`include "voxrt_assert.svh"

module voxrt_ray_queue #(
  parameter int unsigned Width = 8,  // Bits: 1 or more.
  parameter int unsigned Depth = 16  // Rays of each queue: a power of two, 2 or more.
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  input  logic             shadow_i,
  input  logic [Width-1:0] data_i,
  output logic             valid_o,
  output logic             shadow_o,  // Which queue data_o is from.
  input  logic             ready_i,
  output logic [Width-1:0] data_o
);
  if (Width < 1) $error("voxrt_ray_queue: Width must be 1 bit or more");
  if (Depth < 2 || 2 ** $clog2(Depth) != Depth) $error("voxrt_ray_queue: Depth must be a power of two, 2 or more");

  localparam int unsigned IndexBits = $clog2(Depth);

  logic [Width-1:0] data_q[2*Depth];
  logic [IndexBits:0] write_q[2], read_q[2];
  logic [1:0] filled;

  always_comb for (int unsigned i = 0; i < 2; i++) filled[i] = write_q[i] != read_q[i];

  assign valid_o  = filled != '0;
  assign shadow_o = filled[1];
  assign data_o   = data_q[{shadow_o, read_q[shadow_o][IndexBits-1:0]}];

  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      data_q[{shadow_i, write_q[shadow_i][IndexBits-1:0]}] <= data_i;
      write_q[shadow_i]                                    <= write_q[shadow_i] + 1'b1;
    end
    if (valid_o && ready_i) read_q[shadow_o] <= read_q[shadow_o] + 1'b1;
    if (!rst_ni) begin
      write_q <= '{default: '0};
      read_q  <= '{default: '0};
    end
  end

  for (genvar i = 0; i < 2; i++) begin : gen_check
    `VOXRT_ASSERT(CountWithinDepth, (IndexBits + 1)'(write_q[i] - read_q[i]) <= (IndexBits + 1)'(Depth))
  end
endmodule
