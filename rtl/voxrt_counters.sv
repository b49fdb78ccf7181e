// What a frame has cost and met. All stand still between frames.
module voxrt_counters
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes = 1
) (
  input  logic             clk_i,
  input  logic             start_i,               // Of a frame.
  input  logic             rays_start_i,          // Its root has been read, which does not count.
  input  logic             busy_i,
  // A pixel is offered, and accepted; it shows a material.
  input  logic             pixel_valid_i,
  input  logic             pixel_ready_i,
  input  logic             hit_i,
  // A lane has got a word.
  input  logic [Lanes-1:0] word_read_i,
  input  logic             direction_overflow_i,
  input  logic             bad_pointer_i,
  input  logic             step_limit_i,
  output error_t           error_o,               // Sticky.
  output logic [     31:0] cycles_o,
  output logic [     31:0] rays_o,
  output logic [     31:0] words_read_o,
  output logic [     31:0] hits_o,
  output logic [     31:0] stalls_o
);
  logic [31:0] cycles_q, rays_q, words_read_q, hits_q, stalls_q;
  error_t      error_q;

  always_ff @(posedge clk_i) begin
    if (busy_i) cycles_q <= cycles_q + 1'b1;
    if (pixel_valid_i && pixel_ready_i) rays_q <= rays_q + 1'b1;
    if (pixel_valid_i && pixel_ready_i && hit_i) hits_q <= hits_q + 1'b1;
    if (pixel_valid_i && !pixel_ready_i) stalls_q <= stalls_q + 1'b1;
    words_read_q <= words_read_q + 32'($countones(word_read_i));
    if (direction_overflow_i) error_q.direction_overflow <= 1'b1;
    if (bad_pointer_i) error_q.bad_pointer <= 1'b1;
    if (step_limit_i) error_q.step_limit <= 1'b1;
    if (start_i) begin
      cycles_q <= '0;
      rays_q   <= '0;
      hits_q   <= '0;
      stalls_q <= '0;
      error_q  <= '0;
    end
    if (rays_start_i) words_read_q <= '0;
  end

  assign cycles_o     = cycles_q;
  assign rays_o       = rays_q;
  assign words_read_o = words_read_q;
  assign hits_o       = hits_q;
  assign stalls_o     = stalls_q;
  assign error_o      = error_q;
endmodule
