// AXI4-Stream rules (an offered word stays until taken), and the packer against a model that holds bytes in a queue:
// words have their lines' bytes in order, tlast and tkeep where lines end, tuser where frames begin.
module voxrt_pixel_packer_properties
  import voxrt_pkg::*;
(
  input logic    clk_i,
  input logic    rst_ni,
  input logic    valid_i,
  input colour_t colour_i,
  input logic    first_i,
  input logic    line_end_i,
  input logic    tready
);
  logic ready_o, tvalid, tuser, tlast;
  logic [31:0] tdata;
  logic [3:0] tkeep;

  voxrt_pixel_packer dut (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .colour_i,
    .first_i,
    .line_end_i,
    .m_axis_tvalid(tvalid),
    .m_axis_tready(tready),
    .m_axis_tdata (tdata),
    .m_axis_tkeep (tkeep),
    .m_axis_tuser (tuser),
    .m_axis_tlast (tlast)
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb if (!started_q) assume (!rst_ni);

  logic reset_q, tvalid_q, tready_q, tuser_q, tlast_q;
  logic [31:0] tdata_q;
  logic [3:0] tkeep_q;

  always_ff @(posedge clk_i) begin
    reset_q  <= !rst_ni;
    tvalid_q <= tvalid;
    tready_q <= tready;
    tdata_q  <= tdata;
    tkeep_q  <= tkeep;
    tuser_q  <= tuser;
    tlast_q  <= tlast;
  end

  // A frame begins at the first pixel of a line.
  logic line_start_q;
  always_ff @(posedge clk_i) begin
    if (valid_i && ready_o) line_start_q <= line_end_i;
    if (!rst_ni) line_start_q <= 1'b1;
  end
  always_comb if (started_q && valid_i && first_i) assume (line_start_q);

  // The byte followed, of a line: its number in its line, counted at the input and at the output.
  localparam int unsigned CountBits = 5;
  // Registers that start with any value and keep it: what holds holds for all.
  logic [CountBits-1:0] target;  // Number of a byte in a line.
  logic [CountBits-1:0] line;  // Number of a line.
  always_ff @(posedge clk_i) begin
    target <= target;
    line   <= line;
  end
  logic [CountBits-1:0] in_byte_q, in_line_q, out_byte_q, out_line_q, length_q;
  logic [7:0] byte_q;
  logic seen_q, ended_q, first_q;
  logic [2:0] out_bytes;
  logic [CountBits-1:0] offset;

  assign out_bytes = 3'(tkeep[0]) + 3'(tkeep[1]) + 3'(tkeep[2]) + 3'(tkeep[3]);
  assign offset    = target - in_byte_q;

  always_ff @(posedge clk_i) begin
    if (valid_i && ready_o) begin
      in_byte_q <= in_byte_q + CountBits'(3);
      if (in_line_q == line) begin
        if (in_byte_q == '0) first_q <= first_i;
        if (target >= in_byte_q && offset < CountBits'(3)) begin
          seen_q <= 1'b1;
          byte_q <= offset == '0 ? colour_i.green : offset == CountBits'(1) ? colour_i.blue : colour_i.red;
        end
        if (line_end_i) begin
          ended_q  <= 1'b1;
          length_q <= in_byte_q + CountBits'(3);
        end
      end
      if (line_end_i) begin
        in_byte_q <= '0;
        in_line_q <= in_line_q + 1'b1;
      end
    end
    if (tvalid && tready) begin
      out_byte_q <= tlast ? '0 : out_byte_q + CountBits'(out_bytes);
      if (tlast) out_line_q <= out_line_q + 1'b1;
    end
    if (!rst_ni) begin
      in_byte_q  <= '0;
      in_line_q  <= '0;
      out_byte_q <= '0;
      out_line_q <= '0;
      seen_q     <= 1'b0;
      ended_q    <= 1'b0;
    end
  end

  always_comb begin
    // Counters that wrap would say nothing.
    if (started_q) assume (in_byte_q < CountBits'(25) && in_line_q < CountBits'(30));
    if (started_q && !reset_q && tvalid_q && !tready_q) begin
      assert (tvalid && tdata == tdata_q && tkeep == tkeep_q && tuser == tuser_q && tlast == tlast_q);
    end
    if (started_q && tvalid) begin
      assert (tkeep == 4'b1111 || (tlast && (tkeep == 4'b0111 || tkeep == 4'b0011 || tkeep == 4'b0001)));
      if (out_line_q == line) begin
        assert (tuser == (out_byte_q == '0 && first_q));
        if (target >= out_byte_q && target - out_byte_q < CountBits'(out_bytes)) begin
          assert (seen_q);
          assert (8'(tdata >> (8 * 2'(target - out_byte_q))) == byte_q);
        end
        if (tlast)
          assert (ended_q && length_q == out_byte_q + CountBits'(out_bytes));
          else if (ended_q) assert (out_byte_q + CountBits'(out_bytes) < length_q);
      end
    end
  end

  always_ff @(posedge clk_i) begin
    cover (started_q && tvalid && tlast && tkeep == 4'b0001);
    cover (started_q && tvalid && tlast && tkeep == 4'b1111);
    cover (started_q && tvalid && tuser && out_line_q != '0);
  end
endmodule
