// Whatever the order in which entries are completed, pixels come out in the order in which entries were allocated, each
// as it was stored, and none before it was completed. The environment stores and completes only entries that are
// allocated and not completed, and stores each once, no later than it completes it.
module voxrt_pixel_buffer_properties #(
  parameter int unsigned Width = 3,
  parameter int unsigned Depth = 4
) (
  input logic                   clk_i,
  input logic                   rst_ni,
  input logic                   allocate_i,
  input logic                   complete_i,
  input logic [$clog2(Depth):0] tag_i,
  input logic                   lit_i,
  input logic                   store_i,
  input logic [      Width-1:0] pixel_i,
  input logic                   ready_i
);
  localparam int unsigned TagBits = $clog2(Depth) + 1;

  logic ready_o, valid_o, lit_o;
  logic [TagBits-1:0] tag_o;
  logic [Width-1:0] pixel_o;

  voxrt_pixel_buffer #(
    .Width        (Width),
    .Depth        (Depth),
    .StoresEarlier(1'b1)
  ) dut (
    .clk_i,
    .rst_ni,
    .allocate_i,
    .ready_o,
    .tag_o,
    .complete_i,
    .tag_i,
    .lit_i,
    .store_i,
    .pixel_i,
    .valid_o,
    .ready_i,
    .lit_o,
    .pixel_o
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);

  // Tags that are allocated and not completed yet.
  logic [2**TagBits-1:0] open_q;

  always_ff @(posedge clk_i) begin
    if (allocate_i) open_q[tag_o] <= 1'b1;
    if (complete_i) open_q[tag_i] <= 1'b0;
    if (!rst_ni) open_q <= '0;
  end

  // A ray that is resolved allocates and completes its entry at the same clock.
  always_comb begin
    if (allocate_i) assume (ready_o);
    if (complete_i || store_i) assume (open_q[tag_i] || (allocate_i && tag_i == tag_o));
  end

  // The pixel followed, by its number; numbers run from the reset on.
  localparam int unsigned CountBits = 4;
  // A register that starts with any value and keeps it: what holds holds for all.
  logic [CountBits-1:0] target;
  always_ff @(posedge clk_i) target <= target;
  logic [CountBits-1:0] allocated_q, read_q;
  logic completed_q, stored_q, lit_q;
  logic [TagBits-1:0] tag_q;
  logic [Width-1:0] pixel_q;
  logic is_target, completes_now;

  assign is_target = !completed_q &&
      (allocated_q > target ? tag_i == tag_q : allocated_q == target && allocate_i && tag_i == tag_o);
  assign completes_now = complete_i && is_target;

  always_comb if (completes_now) assume (stored_q || store_i);
  always_comb if (store_i && is_target) assume (!stored_q);

  always_ff @(posedge clk_i) begin
    if (allocate_i) allocated_q <= allocated_q + 1'b1;
    if (allocate_i && allocated_q == target) tag_q <= tag_o;
    if (completes_now) begin
      completed_q <= 1'b1;
      lit_q       <= lit_i;
    end
    if (store_i && is_target) begin
      stored_q <= 1'b1;
      pixel_q  <= pixel_i;
    end
    if (valid_o && ready_i) read_q <= read_q + 1'b1;
    if (!rst_ni) begin
      allocated_q <= '0;
      read_q      <= '0;
      completed_q <= 1'b0;
      stored_q    <= 1'b0;
    end
  end

  always_comb begin
    if (started_q) begin
      // Counters that wrap would say nothing.
      assume (allocated_q < CountBits'(14));
      assert (read_q <= allocated_q);
      if (valid_o) assert (read_q < allocated_q);
      if (valid_o && read_q == target) assert (completed_q && pixel_o == pixel_q && lit_o == lit_q);
    end
  end

  always_ff @(posedge clk_i) begin
    cover (started_q && read_q == CountBits'(3) && valid_o);
    cover (started_q && valid_o && read_q == target && target == CountBits'(3));
  end
endmodule
