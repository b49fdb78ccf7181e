// Controller of an SDR SDRAM of 32 MB (16 bits, 4 banks, 8192 rows, 512 columns): reads and writes lines of 32 bytes.
//
// One line at a time, in 23 clocks: activate, two bursts of 8, the second with automatic precharge. CAS latency 3. The
// counts of clocks hold up to 80 MHz for parts of speed -7 and faster. The chip's clock is this one, later by a quarter
// of a period: commands have a quarter to arrive, answers three quarters less what the chip takes.
module board_sdram #(
  parameter int unsigned ClockHz   = 75_000_000,
  parameter int unsigned PowerOnUs = 200          // The chip is left alone after power-on.
) (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         request_valid_i,
  output logic         request_ready_o,
  input  logic         request_write_i,
  input  logic [ 19:0] request_line_i,
  input  logic [ 15:0] request_mask_i,   // Which half words are written.
  input  logic [255:0] request_data_i,
  output logic         done_o,           // For one clock; of a read, with the line.
  output logic [255:0] line_o,
  // To the pins.
  output logic         sdram_cke_o,
  output logic         sdram_cs_no,
  output logic         sdram_ras_no,
  output logic         sdram_cas_no,
  output logic         sdram_we_no,
  output logic [  1:0] sdram_ba_o,
  output logic [ 12:0] sdram_a_o,
  output logic [  1:0] sdram_dqm_o,
  output logic         sdram_dq_oe_o,
  output logic [ 15:0] sdram_dq_o,
  input  logic [ 15:0] sdram_dq_i
);
  localparam int unsigned PowerOnClocks = (ClockHz / 1000) * PowerOnUs / 1000;
  // 8192 rows in 64 ms, less what a line under way takes.
  localparam int unsigned RefreshClocks = (ClockHz / 1000) * 64 / 8192 - 32;
  localparam int unsigned CountBits = $clog2(PowerOnClocks + 1);
  localparam int unsigned RefreshBits = $clog2(RefreshClocks + 1);
  localparam logic [4:0] LastStep = 5'd21;
  localparam logic [12:0] Mode = 13'h033;  // Bursts of 8, sequential, CAS latency 3.

  // {RAS, CAS, WE}, low.
  typedef enum logic [2:0] {
    SetMode   = 3'b000,
    Refresh   = 3'b001,
    Precharge = 3'b010,
    Activate  = 3'b011,
    Write     = 3'b100,
    Read      = 3'b101,
    None      = 3'b111
  } command_e;

  typedef enum logic [2:0] {
    PowerOn,
    Prepare,
    Idle,
    Refreshing,
    Access
  } state_e;

  state_e   state_q;
  command_e command_q;
  logic [  CountBits-1:0] count_q;
  logic [RefreshBits-1:0] refresh_q;
  logic                   refresh_due_q, write_q, selected_q;
  logic [            4:0] step_q;
  logic [           19:0] line_address_q;
  logic [           15:0] mask_q, dq_q;
  logic [          255:0] data_q;

  assign request_ready_o = state_q == Idle && !refresh_due_q;
  assign sdram_cke_o     = 1'b1;
  // Flip-flops are 0 after configuration: the chip is not selected until the first clock out of reset.
  assign sdram_cs_no     = !selected_q;
  assign {sdram_ras_no, sdram_cas_no, sdram_we_no} = command_q;
  assign line_o = data_q;

  always_ff @(posedge clk_i) begin
    command_q     <= None;
    selected_q    <= 1'b1;
    sdram_dqm_o   <= '0;
    sdram_dq_oe_o <= 1'b0;
    dq_q          <= sdram_dq_i;
    done_o        <= 1'b0;
    refresh_q     <= refresh_q - 1'b1;
    if (refresh_q == '0) begin
      refresh_q     <= RefreshBits'(RefreshClocks);
      refresh_due_q <= 1'b1;
    end
    step_q <= step_q + 5'd1;
    unique case (state_q)
      PowerOn: begin
        sdram_dqm_o <= '1;
        count_q     <= count_q - 1'b1;
        if (count_q == '0) begin
          count_q <= CountBits'(99);
          state_q <= Prepare;
        end
      end
      // All banks closed, eight refreshes ten clocks apart, the mode.
      Prepare: begin
        count_q   <= count_q - 1'b1;
        sdram_a_o <= 13'h400;
        unique case (count_q)
          CountBits'(95): command_q <= Precharge;
          CountBits'(90), CountBits'(80), CountBits'(70), CountBits'(60), CountBits'(50), CountBits'(40),
          CountBits'(30), CountBits'(20): command_q <= Refresh;
          CountBits'(10): begin
            command_q  <= SetMode;
            sdram_a_o  <= Mode;
            sdram_ba_o <= '0;
          end
          CountBits'(0): state_q <= Idle;
          default: ;
        endcase
      end
      Idle: begin
        step_q <= '0;
        if (refresh_due_q) begin
          refresh_due_q <= 1'b0;
          command_q     <= Refresh;
          state_q       <= Refreshing;
        end else if (request_valid_i) begin
          write_q        <= request_write_i;
          line_address_q <= request_line_i;
          mask_q         <= request_mask_i;
          data_q         <= request_data_i;
          state_q        <= Access;
        end
      end
      Refreshing: if (step_q == 5'd5) state_q <= Idle;
      Access: begin
        sdram_ba_o <= line_address_q[6:5];
        if (step_q == 5'd0) begin
          command_q <= Activate;
          sdram_a_o <= line_address_q[19:7];
        end
        if (step_q == 5'd2 || step_q == 5'd10) begin
          command_q <= write_q ? Write : Read;
          sdram_a_o <= {2'b00, step_q[3], 1'b0, line_address_q[4:0], step_q[3], 3'd0};
        end
        if (write_q) begin
          if (step_q >= 5'd2 && step_q < 5'd18) begin
            sdram_dq_oe_o <= 1'b1;
            sdram_dq_o    <= data_q[15:0];
            sdram_dqm_o   <= {2{!mask_q[0]}};
            data_q        <= {16'd0, data_q[255:16]};
            mask_q        <= {1'b0, mask_q[15:1]};
          end
        end else if (step_q >= 5'd6) begin
          data_q <= {dq_q, data_q[255:16]};
        end
        if (step_q == LastStep) begin
          done_o  <= 1'b1;
          state_q <= Idle;
        end
      end
      default: state_q <= PowerOn;
    endcase
    if (!rst_ni) begin
      state_q       <= PowerOn;
      selected_q    <= 1'b0;
      command_q     <= None;
      count_q       <= CountBits'(PowerOnClocks);
      refresh_q     <= RefreshBits'(RefreshClocks);
      refresh_due_q <= 1'b0;
      done_o        <= 1'b0;
    end
  end
endmodule
