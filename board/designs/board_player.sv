// Plays a list of the table (docs/ecp5_boards.md): reads headers and data by the bus, and writes by the bus.
module board_player
  import board_pkg::*;
(
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    start_i,    // Only while busy_o is low.
  input  logic    [TableBits-1:0] word_i,     // The word at which the list begins.
  input  logic                    camera_i,   // The list has 16 words at most.
  output logic                    busy_o,
  output logic                    refused_o,  // A write was refused; for one clock.
  // Bus.
  output logic                    valid_o,
  output access_t                 access_o,
  input  logic                    done_i,
  input  logic    [         31:0] data_i,
  input  logic                    refused_i
);
  typedef enum logic [1:0] {
    Idle,
    Header,
    Data,
    Write
  } state_e;

  state_e state_q;
  logic [TableBits:0] word_q;  // One beyond the table ends the list.
  logic [4:0] left_q;  // Words of a camera that are left.
  logic camera_q, ends;
  logic [7:0] count_q;
  logic [23:0] address_q;
  logic [31:0] data_q;

  assign busy_o = state_q != Idle;
  assign ends   = word_q[TableBits] || (camera_q && left_q == '0);

  always_ff @(posedge clk_i) begin
    refused_o <= 1'b0;
    valid_o   <= 1'b0;
    unique case (state_q)
      Idle: begin
        word_q   <= {1'b0, word_i};
        camera_q <= camera_i;
        left_q   <= 5'd16;
        if (start_i) state_q <= Header;
      end
      Header, Data: begin
        valid_o <= !ends && !done_i;
        if (ends) state_q <= Idle;
        if (done_i) begin
          word_q  <= word_q + 1'b1;
          left_q  <= left_q - 1'b1;
          data_q  <= data_i;
          state_q <= Write;
          if (state_q == Header) begin
            count_q   <= data_i[31:24];
            address_q <= data_i[23:0];
            state_q   <= data_i[31:24] == '0 ? Idle : Data;
          end
        end
      end
      default: begin
        valid_o <= !done_i;
        if (done_i) begin
          refused_o <= refused_i;
          count_q   <= count_q - 1'b1;
          address_q <= address_q + 24'd4;
          state_q   <= count_q == 8'd1 ? Header : Data;
        end
      end
    endcase
    if (!rst_ni) begin
      state_q <= Idle;
      valid_o <= 1'b0;
    end
  end

  always_comb begin
    access_o.write   = state_q == Write;
    access_o.address = state_q == Write ? address_q : 24'h004000 + 24'({word_q[TableBits-1:0], 2'b00});
    access_o.data    = data_q;
  end
endmodule
