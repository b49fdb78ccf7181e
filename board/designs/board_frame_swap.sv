// Decides which of the two frames in the SDRAM the screen shows, and which one the core draws.
//
// A new frame of the core says that the one before is complete: it is shown from now on, if the screen reads no frame, or
// as soon as it has read the old one. Until then the new one waits. So the screen never shows a part of a frame.
module board_frame_swap (
  input  logic       clk_i,
  input  logic       rst_ni,
  input  logic       new_frame_i,    // The core starts a frame; for one clock.
  input  logic [1:0] scale_i,        // The scale of that frame.
  input  logic       reading_i,      // The screen reads a frame.
  output logic       hold_o,         // The new frame waits.
  output logic       drawn_o,        // The frame that the core draws.
  output logic       shown_o,
  output logic [1:0] shown_scale_o,
  output logic       visible_o       // There is a frame to be shown.
);
  logic pending_q, began_q;
  logic [1:0] scale_q, drawn_scale_q;

  assign hold_o = new_frame_i || pending_q;

  always_ff @(posedge clk_i) begin
    if (pending_q && !reading_i) begin
      pending_q     <= 1'b0;
      began_q       <= 1'b1;
      visible_o     <= began_q;
      shown_o       <= drawn_o;
      shown_scale_o <= drawn_scale_q;
      drawn_o       <= !drawn_o;
      drawn_scale_q <= scale_q;
    end
    if (new_frame_i) begin
      pending_q <= 1'b1;
      scale_q   <= scale_i;
    end
    if (!rst_ni) begin
      pending_q     <= 1'b0;
      began_q       <= 1'b0;
      visible_o     <= 1'b0;
      shown_o       <= 1'b0;
      shown_scale_o <= '0;
      drawn_o       <= 1'b0;
    end
  end
endmodule
