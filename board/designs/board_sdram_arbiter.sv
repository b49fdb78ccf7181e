// Several ports to one SDRAM controller, a line at a time.
//
// A port holds its request until ready_o; done_o comes once for each, in the order of the port's requests. Port 0, the
// screen's, goes first while it is urgent, and else not twice while another waits; the others in turn. So each of the
// others has a line after Ports - 1 lines at most of its equals, and as many of the screen, while the screen is not urgent.
module board_sdram_arbiter #(
  parameter int unsigned Ports = 5  // 2 or more.
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    urgent_i,
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
  output logic [     19:0]        request_line_o,
  output logic [     15:0]        request_mask_o,
  output logic [    255:0]        request_data_o,
  input  logic                    done_i
);
  if (Ports < 2) $error("board_sdram_arbiter: Ports must be 2 or more");

  localparam int unsigned PortBits = $clog2(Ports);
  localparam int unsigned UnderWayBits = 2;  // The controller has three lines at most.

  logic [Ports-1:0] others, later, late_q;  // late_q: ports behind the last one that had a line.
  logic [PortBits-1:0] next;
  logic screen_q;  // The screen had the line before.
  logic [PortBits-1:0] owners_q[2**UnderWayBits];
  logic [UnderWayBits-1:0] first_q, last_q;

  assign others = valid_i & ~Ports'(1);
  assign later  = (others & late_q) != '0 ? others & late_q : others;

  always_comb begin
    next = '0;
    for (int unsigned i = Ports - 1; i >= 1; i--) if (later[i]) next = PortBits'(i);
    if (valid_i[0] && (urgent_i || !screen_q)) next = '0;
  end

  assign request_valid_o = valid_i != '0;
  assign request_write_o = write_i[next];
  assign request_line_o  = line_i[next];
  assign request_mask_o  = mask_i[next];

  // Ports that only read bring zeros: no multiplexer.
  always_comb begin
    request_data_o = '0;
    for (int unsigned i = 0; i < Ports; i++) if (next == PortBits'(i)) request_data_o |= data_i[i];
  end

  always_comb begin
    ready_o                   = '0;
    ready_o[next]             = request_ready_i && request_valid_o;
    done_o                    = '0;
    done_o[owners_q[first_q]] = done_i;
  end

  always_ff @(posedge clk_i) begin
    if (request_valid_o && request_ready_i) begin
      owners_q[last_q] <= next;
      last_q           <= last_q + 1'b1;
      screen_q         <= next == '0;
      if (next != '0) begin
        for (int unsigned i = 0; i < Ports; i++) late_q[i] <= PortBits'(i) > next;
      end
    end
    if (done_i) first_q <= first_q + 1'b1;
    if (!rst_ni) begin
      late_q   <= '0;
      screen_q <= 1'b0;
      first_q  <= '0;
      last_q   <= '0;
    end
  end
endmodule
