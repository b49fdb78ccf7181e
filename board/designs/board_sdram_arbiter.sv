// Several ports to one SDRAM controller, a line at a time.
//
// Port 0, the screen's, goes first, but not twice while another waits; the others in turn. A port holds its request
// until ready_o, and has one under way: done_o comes with what was read.
module board_sdram_arbiter #(
  parameter int unsigned Ports = 4
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic [Ports-1:0]        valid_i,
  output logic [Ports-1:0]        ready_o,
  input  logic [Ports-1:0]        write_i,
  input  logic [Ports-1:0][ 19:0] line_i,
  input  logic [Ports-1:0][ 15:0] mask_i,
  input  logic [Ports-1:0][255:0] data_i,
  output logic [Ports-1:0]        done_o,
  // To the controller.
  output logic                    request_valid_o,
  input  logic                    request_ready_i,
  output logic                    request_write_o,
  output logic [ 19:0]            request_line_o,
  output logic [ 15:0]            request_mask_o,
  output logic [255:0]            request_data_o,
  input  logic                    done_i
);
  localparam int unsigned PortBits = $clog2(Ports);

  logic [PortBits-1:0] next, last_q, owner_q;
  logic                screen_q;  // The screen had the line before.

  always_comb begin
    next = '0;
    // The port that follows the last one counts last here, so that it wins.
    for (int unsigned i = Ports - 1; i >= 1; i--) begin
      if (valid_i[PortBits'((32'(last_q) - 1 + i) % (Ports - 1) + 1)]) begin
        next = PortBits'((32'(last_q) - 1 + i) % (Ports - 1) + 1);
      end
    end
    if (valid_i[0] && !screen_q) next = '0;
  end

  assign request_valid_o = valid_i != '0;
  assign request_write_o = write_i[next];
  assign request_line_o  = line_i[next];
  assign request_mask_o  = mask_i[next];
  assign request_data_o  = data_i[next];

  always_comb begin
    ready_o       = '0;
    ready_o[next] = request_ready_i && request_valid_o;
    done_o          = '0;
    done_o[owner_q] = done_i;
  end

  always_ff @(posedge clk_i) begin
    if (request_valid_o && request_ready_i) begin
      owner_q  <= next;
      screen_q <= next == '0;
      if (next != '0) last_q <= next;
    end
    if (!rst_ni) begin
      last_q   <= PortBits'(1);
      screen_q <= 1'b0;
    end
  end
endmodule
