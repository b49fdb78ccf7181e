// Turns the core's video stream (rtl/shading/voxrt_pixel_packer.sv) back into pixels of 24 bits, red highest: 3 words
// give 4 pixels. Widths are multiples of 4 pixels.
module board_unpacker (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        s_axis_tvalid,
  output logic        s_axis_tready,
  input  logic [31:0] s_axis_tdata,
  input  logic        s_axis_tuser,
  input  logic        s_axis_tlast,
  output logic        valid_o,
  input  logic        ready_i,
  output logic [23:0] pixel_o,
  output logic        line_end_o
);
  logic [23:0] kept_q;  // Bytes that belong to the next pixel, the first one lowest.
  logic [1:0] bytes_q, bytes;
  logic last_q;
  logic [23:0] pixel;

  // The first word of a frame begins with a pixel, whatever was before.
  assign bytes         = s_axis_tvalid && s_axis_tuser ? 2'd0 : bytes_q;
  assign valid_o       = bytes == 2'd3 || s_axis_tvalid;
  assign s_axis_tready = bytes != 2'd3 && ready_i;
  assign line_end_o    = bytes == 2'd3 && last_q;

  always_comb begin
    unique case (bytes)
      2'd0: pixel = s_axis_tdata[23:0];
      2'd1: pixel = {s_axis_tdata[15:0], kept_q[7:0]};
      2'd2: pixel = {s_axis_tdata[7:0], kept_q[15:0]};
      2'd3: pixel = kept_q;
    endcase
  end

  // The bytes of a pixel are green, blue, red.
  assign pixel_o = {pixel[23:16], pixel[7:0], pixel[15:8]};

  always_ff @(posedge clk_i) begin
    if (valid_o && ready_i) begin
      bytes_q <= bytes + 1'b1;
      last_q  <= s_axis_tlast;
      unique case (bytes)
        2'd0:    kept_q <= {16'd0, s_axis_tdata[31:24]};
        2'd1:    kept_q <= {8'd0, s_axis_tdata[31:16]};
        default: kept_q <= s_axis_tdata[31:8];
      endcase
    end
    if (!rst_ni) begin
      bytes_q <= '0;
      last_q  <= 1'b0;
    end
  end
endmodule
