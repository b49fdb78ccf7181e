// Whatever the order in which places are filled, pixels come out in the order in which places were taken, each with
// what was stored in its place, and none before it was filled. The environment stores in and fills only places that are
// taken and not filled, and stores in it once, no later than it fills it.
module voxrt_pixel_buffer_properties #(
  parameter  int unsigned Width   = 3,
  parameter  int unsigned Depth   = 4,
  localparam int unsigned TagBits = $clog2(Depth) + 1
) (
  input logic               clk_i,
  input logic               rst_ni,
  input logic               take_i,
  input logic               fill_i,
  input logic [TagBits-1:0] tag_i,
  input logic               lit_i,
  input logic               store_i,
  input logic [  Width-1:0] pixel_i,
  input logic               ready_i
);
  logic               ready_o, valid_o, lit_o;
  logic [TagBits-1:0] tag_o;
  logic [  Width-1:0] pixel_o;

  voxrt_pixel_buffer #(
    .Width      (Width),
    .Depth      (Depth),
    .StoresFirst(1'b1)
  ) dut (
    .clk_i,
    .rst_ni,
    .take_i,
    .ready_o,
    .tag_o,
    .fill_i,
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

  // Which tags are taken and not filled yet.
  logic [2**TagBits-1:0] open_q;

  always_ff @(posedge clk_i) begin
    if (take_i) open_q[tag_o] <= 1'b1;
    if (fill_i) open_q[tag_i] <= 1'b0;
    if (!rst_ni) open_q <= '0;
  end

  // A ray that is resolved at once takes and fills its place at the same clock.
  always_comb begin
    if (take_i) assume (ready_o);
    if (fill_i || store_i) assume (open_q[tag_i] || (take_i && tag_i == tag_o));
  end

  // The pixel followed, by its number; numbers run from the reset on.
  localparam int unsigned CountBits = 4;
  // A register that starts with any value and keeps it: what holds holds for all.
  logic [CountBits-1:0] target;
  always_ff @(posedge clk_i) target <= target;
  logic [CountBits-1:0] taken_q, given_q;
  logic                 filled_q, stored_q, lit_q;
  logic [  TagBits-1:0] tag_q;
  logic [    Width-1:0] pixel_q;
  logic                 is_target, fills_now;

  assign is_target = !filled_q && (taken_q > target ? tag_i == tag_q : taken_q == target && take_i && tag_i == tag_o);
  assign fills_now = fill_i && is_target;

  always_comb if (fills_now) assume (stored_q || store_i);
  always_comb if (store_i && is_target) assume (!stored_q);

  always_ff @(posedge clk_i) begin
    if (take_i) taken_q <= taken_q + 1'b1;
    if (take_i && taken_q == target) tag_q <= tag_o;
    if (fills_now) begin
      filled_q <= 1'b1;
      lit_q    <= lit_i;
    end
    if (store_i && is_target) begin
      stored_q <= 1'b1;
      pixel_q  <= pixel_i;
    end
    if (valid_o && ready_i) given_q <= given_q + 1'b1;
    if (!rst_ni) begin
      taken_q  <= '0;
      given_q  <= '0;
      filled_q <= 1'b0;
      stored_q <= 1'b0;
    end
  end

  always_comb begin
    if (started_q) begin
      // Counters that wrap would say nothing.
      assume (taken_q < CountBits'(14));
      assert (given_q <= taken_q);
      if (valid_o) assert (given_q < taken_q);
      if (valid_o && given_q == target) assert (filled_q && pixel_o == pixel_q && lit_o == lit_q);
    end
  end

  always_ff @(posedge clk_i) begin
    cover (started_q && given_q == CountBits'(3) && valid_o);
    cover (started_q && valid_o && given_q == target && target == CountBits'(3));
  end
endmodule
