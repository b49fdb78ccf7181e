// The octree and two frames in an SDRAM: its users, one after the other, and the screen's way to the frames. The screen
// shows whole frames at its own rate, whatever a scene costs.
//
// Lines of 32 bytes in the SDRAM: up to 0xEFFFF the octree, word 0 at the end of line 0; from 0xF0000 on two frames, each
// of 480 rows of 64 lines.
module board_sdram_memory
  import board_pkg::*;
  import voxrt_pkg::*;
#(
  parameter int unsigned BootBlockBits = 12,
  parameter int unsigned ClockHz       = 57_692_307,
  parameter int unsigned PowerOnUs     = 200,
  // What the boot memory holds from the beginning, for $readmemh.
  parameter string       OctreeFile    = ""
) (
  // System clock.
  input logic clk_i,
  input logic rst_ni,
  output sdram_out_t sdram_o,
  input logic [15:0] sdram_dq_i,
  // The core's reads.
  input axi_read_request_t [1:0] axi_i,
  output axi_read_response_t [1:0] axi_o,
  // Accesses of serial line and player: those of words end here, others go on to the bus.
  input logic [1:0] valid_i,
  input access_t [1:0] access_i,
  output logic [1:0] done_o,
  output logic [1:0][31:0] data_o,
  output logic [1:0] refused_o,
  output logic [1:0] bus_valid_o,
  input logic [1:0] bus_done_i,
  input logic [31:0] bus_data_i,
  input logic bus_refused_i,
  // Frames. None starts before the boot scene is in the SDRAM.
  input logic new_frame_i,
  input logic [1:0] scale_i,
  output logic flush_o,  // The core's caches may hold words as they were before a write.
  input logic s_axis_tvalid,
  output logic s_axis_tready,
  input logic [31:0] s_axis_tdata,
  input logic s_axis_tuser,
  input logic s_axis_tlast,
  output logic row_event_o,
  output row_event_t row_o,
  // Pixel clock.
  input logic pixel_clk_i,
  input logic pixel_rst_ni,
  input logic row_begin_i,
  input logic [9:0] row_i,
  input logic [9:0] column_i,
  output logic [23:0] pixel_o
);
  // Ports of the arbiter: the screen, the core's two, words of the host and of lists, the boot scene, the core's pixels.
  localparam int unsigned Screen = 0;
  localparam int unsigned Core = 1;
  localparam int unsigned Words = 3;
  localparam int unsigned Boot = 4;
  localparam int unsigned Pixels = 5;
  localparam int unsigned Ports = 6;

  logic [Ports-1:0] valid, ready, writes, done;
  logic [Ports-1:0][19:0] lines;
  logic [Ports-1:0][15:0] masks;
  logic [Ports-1:0][255:0] data;
  logic urgent, request_valid, request_ready, request_write, request_done;
  logic [19:0] request_line;
  logic [15:0] request_mask;
  logic [255:0] request_data, read_data;

  for (genvar i = 0; i < 2; i++) begin : gen_axi
    board_sdram_axi u_axi (
      .clk_i,
      .rst_ni,
      .axi_i  (axi_i[i]),
      .axi_o  (axi_o[i]),
      .valid_o(valid[Core+i]),
      .ready_i(ready[Core+i]),
      .line_o (lines[Core+i]),
      .done_i (done[Core+i]),
      .data_i (read_data)
    );
  end

  logic booting, written, row_event;

  assign row_event_o = row_event && !booting;

  // What was written since the last frame started may be in the core's caches as it was before.
  always_ff @(posedge clk_i) begin
    if (new_frame_i) flush_o <= 1'b0;
    if (written) flush_o <= 1'b1;
    if (!rst_ni) flush_o <= 1'b0;
  end

  board_memory_port u_memory (
    .clk_i,
    .rst_ni,
    .valid_i,
    .access_i,
    .done_o,
    .data_o,
    .refused_o,
    .written_o  (written),
    .bus_valid_o,
    .bus_done_i,
    .bus_data_i,
    .bus_refused_i,
    .valid_o    (valid[Words]),
    .ready_i    (ready[Words]),
    .write_o    (writes[Words]),
    .line_o     (lines[Words]),
    .mask_o     (masks[Words]),
    .line_data_o(data[Words]),
    .done_i     (done[Words]),
    .line_data_i(read_data)
  );

  board_boot_copy #(
    .BlockBits(BootBlockBits),
    .File     (OctreeFile)
  ) u_boot (
    .clk_i,
    .rst_ni,
    .busy_o (booting),
    .valid_o(valid[Boot]),
    .ready_i(ready[Boot]),
    .line_o (lines[Boot]),
    .data_o (data[Boot]),
    .done_i (done[Boot])
  );

  // SDRAM. Screen and core do not write.
  for (genvar i = 0; i < Words; i++) begin : gen_read_only
    assign writes[i] = 1'b0;
    assign masks[i]  = '0;
    assign data[i]   = '0;
  end

  assign writes[Boot]   = 1'b1;
  assign masks[Boot]    = '1;
  assign writes[Pixels] = 1'b1;

  board_sdram_arbiter #(
    .Ports(Ports)
  ) u_arbiter (
    .clk_i,
    .rst_ni,
    .urgent_i       (urgent),
    .valid_i        (valid),
    .ready_o        (ready),
    .write_i        (writes),
    .line_i         (lines),
    .mask_i         (masks),
    .data_i         (data),
    .done_o         (done),
    .request_valid_o(request_valid),
    .request_ready_i(request_ready),
    .request_write_o(request_write),
    .request_line_o (request_line),
    .request_mask_o (request_mask),
    .request_data_o (request_data),
    .done_i         (request_done)
  );

  board_sdram #(
    .ClockHz  (ClockHz),
    .PowerOnUs(PowerOnUs)
  ) u_sdram (
    .clk_i,
    .rst_ni,
    .request_valid_i(request_valid),
    .request_ready_o(request_ready),
    .request_write_i(request_write),
    .request_line_i (request_line),
    .request_mask_i (request_mask),
    .request_data_i (request_data),
    .done_o         (request_done),
    .line_o         (read_data),
    .sdram_o,
    .sdram_dq_i
  );

  // Frames.
  logic hold, drawn, shown, visible, reading;
  logic [1:0] shown_scale;

  board_frame_swap u_swap (
    .clk_i,
    .rst_ni,
    .new_frame_i,
    .scale_i,
    .reading_i    (reading),
    .hold_o       (hold),
    .drawn_o      (drawn),
    .shown_o      (shown),
    .shown_scale_o(shown_scale),
    .visible_o    (visible)
  );

  board_frame_writer u_writer (
    .clk_i,
    .rst_ni,
    .frame_i(drawn),
    .hold_i (hold),
    .s_axis_tvalid,
    .s_axis_tready,
    .s_axis_tdata,
    .s_axis_tuser,
    .s_axis_tlast,
    .valid_o(valid[Pixels]),
    .ready_i(ready[Pixels]),
    .line_o (lines[Pixels]),
    .mask_o (masks[Pixels]),
    .data_o (data[Pixels])
  );

  board_frame_reader u_reader (
    .clk_i,
    .rst_ni,
    .visible_i  (visible),
    .frame_i    (shown),
    .scale_i    (shown_scale),
    .reading_o  (reading),
    .row_event_o(row_event),
    .row_o,
    .valid_o    (valid[Screen]),
    .ready_i    (ready[Screen]),
    .urgent_o   (urgent),
    .line_o     (lines[Screen]),
    .done_i     (done[Screen]),
    .data_i     (read_data),
    .pixel_clk_i,
    .pixel_rst_ni,
    .row_begin_i,
    .row_i,
    .column_i,
    .pixel_o
  );
endmodule
