// Gives out the rows of a memory and takes them back in any order. After a reset all rows are free.
//
// Use it where the entries of a memory live for different times: the weights of a ray stay until the ray leaves its
// lane, and rays leave in another order than they came. A counter is enough where entries leave in order.
//
// Nobody allocates more rows than there are. So the list of freed rows is as long as the memory, and is not read before
// each row has been allocated once.
`include "voxrt_assert.svh"

module voxrt_free_list #(
  parameter int unsigned RowBits = 5  // 2**RowBits rows: 1 or more.
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               allocate_i,
  output logic [RowBits-1:0] row_o,       // The row that is allocated next.
  input  logic               free_i,
  input  logic [RowBits-1:0] row_i
);
  if (RowBits < 1) $error("voxrt_free_list: RowBits must be 1 bit or more");

  logic [RowBits-1:0] freed_q[2 ** RowBits];
  logic [RowBits-1:0] allocate_q, free_q;
  logic all_allocated_once_q;

  assign row_o = all_allocated_once_q ? freed_q[allocate_q] : allocate_q;

  always_ff @(posedge clk_i) begin
    if (allocate_i) allocate_q <= allocate_q + 1'b1;
    if (allocate_i && allocate_q == '1) all_allocated_once_q <= 1'b1;
    if (free_i) begin
      free_q          <= free_q + 1'b1;
      freed_q[free_q] <= row_i;
    end
    if (!rst_ni) begin
      allocate_q           <= '0;
      free_q               <= '0;
      all_allocated_once_q <= 1'b0;
    end
  end

`ifndef SYNTHESIS
  logic [2**RowBits-1:0] allocated_q;

  always_ff @(posedge clk_i) begin
    if (allocate_i) allocated_q[row_o] <= 1'b1;
    if (free_i) allocated_q[row_i] <= 1'b0;
    if (!rst_ni) allocated_q <= '0;
  end
`endif
  `VOXRT_ASSERT(AllocatedRowWasFree, !allocate_i || !allocated_q[row_o])
  `VOXRT_ASSERT(FreedRowWasAllocated, !free_i || allocated_q[row_i])
endmodule
