// Counts what a frame costs, and notes what errors it meets. All counters hold between frames, for the registers.
module voxrt_counters
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes = 1
) (
  input  logic                       clk_i,
  input  logic                       start_i,               // A frame starts.
  input  logic                       rays_start_i,          // The root has been read, which does not count.
  input  logic                       busy_i,
  // A pixel is offered, and accepted; it shows a material.
  input  logic                       pixel_valid_i,
  input  logic                       pixel_ready_i,
  input  logic                       hit_i,
  // A lane has received a word.
  input  logic           [Lanes-1:0] word_read_i,
  input  logic                       direction_overflow_i,
  input  logic                       bad_pointer_i,
  input  logic                       step_limit_i,
  input  memory_events_t             memory_events_i,
  output error_t                     error_o,               // Sticky.
  output counters_t                  counters_o
);
  counters_t counters_q;
  error_t error_q;

  always_ff @(posedge clk_i) begin
    if (busy_i) counters_q.cycles <= counters_q.cycles + 1'b1;
    if (pixel_valid_i && pixel_ready_i) counters_q.rays <= counters_q.rays + 1'b1;
    if (pixel_valid_i && pixel_ready_i && hit_i) counters_q.hits <= counters_q.hits + 1'b1;
    if (pixel_valid_i && !pixel_ready_i) counters_q.stalls <= counters_q.stalls + 1'b1;
    counters_q.words_read <= counters_q.words_read + 32'($countones(word_read_i));
    if (direction_overflow_i) error_q.direction_overflow <= 1'b1;
    counters_q.word_requests <= counters_q.word_requests + 32'(memory_events_i.word_requests);
    counters_q.line_requests <= counters_q.line_requests + 32'(memory_events_i.line_requests);
    counters_q.lines_read    <= counters_q.lines_read + 32'(memory_events_i.lines_read);
    if (memory_events_i.bus_error) error_q.bus_error <= 1'b1;
    if (memory_events_i.bus_timeout) error_q.bus_timeout <= 1'b1;
    // The words of lines that the bus did not give are no pointers.
    if (bad_pointer_i && !error_q.bus_error && !error_q.bus_timeout) error_q.bad_pointer <= 1'b1;
    if (step_limit_i) error_q.step_limit <= 1'b1;
    if (start_i) begin
      counters_q.cycles <= '0;
      counters_q.rays   <= '0;
      counters_q.hits   <= '0;
      counters_q.stalls <= '0;
      error_q           <= '0;
    end
    if (rays_start_i) begin
      counters_q.words_read    <= '0;
      counters_q.word_requests <= '0;
      counters_q.line_requests <= '0;
      counters_q.lines_read    <= '0;
    end
  end

  assign counters_o = counters_q;
  assign error_o    = error_q;
endmodule
