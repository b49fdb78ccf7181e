// Decides when frames start and what is written before: the board's registers, buttons and LEDs.
//
// At power-on it plays the boot list. At the beginning of each vertical blanking it waits until the core is idle, plays
// the list that the host asked for and the camera's, and starts a frame. A core that is still busy near the end of
// the blanking is late: no frame starts then, so that no picture begins in the middle of the screen.
module board_frames
  import board_pkg::*;
#(
  // System clock, Hz: 1 or more.
  parameter int unsigned ClockHz    = 75_000_000,
  // The line buffer holds 2**LineBits lines: 4 .. 7.
  parameter int unsigned LineBits   = 4,
  parameter bit          ButtonsLow = 1'b0
) (
  input  logic                          clk_i,
  input  logic                          rst_ni,
  // The board's registers, from the bus.
  input  logic                          register_en_i,
  input  logic                          register_write_i,
  input  logic          [          3:0] register_i,
  input  logic          [         31:0] register_data_i,
  output logic          [         31:0] register_data_o,
  // The player, and the bus while it is idle.
  output logic                          play_o,
  output logic          [TableBits-1:0] play_word_o,
  output logic                          play_camera_o,
  input  logic                          playing_i,
  output logic                          valid_o,
  output access_t                       access_o,
  input  logic                          done_i,
  input  logic          [         31:0] data_i,
  // The line buffer.
  input  logic                          row_event_i,
  input  row_event_t                    row_i,
  input  logic          [         31:0] frame_crc_i,       // Of the core's frame.
  output logic                          drain_o,           // No line is wanted until the next frame starts.
  output logic                          new_frame_o,       // A frame starts; for one clock.
  output logic          [          1:0] scale_o,
  input  count_events_t                 events_i,
  // Pause, reverse, step: any level, any clock.
  input  logic          [          2:0] buttons_i,
  output logic          [          7:0] leds_o
);
  if (ClockHz < 1) $error("board_frames: ClockHz must be 1 Hz or more");
  if (LineBits < 4 || LineBits > 7) $error("board_frames: LineBits must be 4 to 7");

  // The core's registers (rtl/registers.rdl).
  localparam logic [23:0] CoreControl = 24'h00000C;
  localparam logic [23:0] CoreStatus = 24'h000010;
  localparam logic [TableBits-1:0] Cameras = 12'h800;

  // A late frame is given up so many rows before the first visible one. Lists are short against one row.
  localparam int unsigned LastStartRow = RowsTotal - 8;

  typedef enum logic [2:0] {
    Boot,
    Wait,
    Poll,
    List,
    Camera,
    Start,
    Play
  } state_e;

  state_e state_q, next_q;  // next_q: after Play.

  // Registers.
  typedef struct packed {
    logic [7:0] period;
    logic [1:0] scale;
    logic       steered;
    logic       backward;
    logic       turn;
    logic       run;
  } control_t;

  control_t control_q;
  logic [6:0] camera_q;
  logic [7:0] shown_q;  // How many frames show the camera.
  logic pending_q;
  logic [TableBits-1:0] list_q;
  logic [31:0] frames_q, underruns_q, late_q, requests_q, bad_requests_q, refused_q;
  logic underrun_frame_q, underrun_led_q, late_led_q, bad_led_q;

  // Buttons, once per frame: they bounce for less.
  logic [2:0] buttons_q[3], pressed;
  logic blanking, too_late;

  assign blanking = row_event_i && row_i.row == 10'(Rows);
  assign too_late = row_event_i && row_i.row == 10'(LastStartRow);
  assign pressed  = buttons_q[1] & ~buttons_q[2];

  always_ff @(posedge clk_i) begin
    buttons_q[0] <= buttons_i ^ {3{ButtonsLow}};
    if (blanking) begin
      buttons_q[1] <= buttons_q[0];
      buttons_q[2] <= buttons_q[1];
    end
    if (!rst_ni) buttons_q <= '{default: '1};
  end

  logic busy_polled, writes, steps, turns;

  assign busy_polled = data_i[0];
  assign writes      = register_en_i && register_write_i;
  assign turns       = state_q == Start && done_i && control_q.turn;
  assign steps       = blanking && pressed[2];

  always_ff @(posedge clk_i) begin
    play_o      <= 1'b0;
    valid_o     <= 1'b0;
    new_frame_o <= 1'b0;

    unique case (state_q)
      Boot: begin
        play_o        <= 1'b1;
        play_word_o   <= '0;
        play_camera_o <= 1'b0;
        next_q        <= Wait;
        state_q       <= Play;
      end
      Wait: if (blanking) state_q <= Poll;
      Poll: begin
        valid_o <= !done_i;
        if (done_i && !busy_polled) state_q <= List;
        else if (too_late) begin
          late_q     <= late_q + 1'b1;
          late_led_q <= 1'b1;
        end
        // A frame starts only when no access is under way.
        if (late_led_q && done_i) state_q <= Wait;
      end
      List: begin
        play_o        <= pending_q;
        play_word_o   <= list_q;
        play_camera_o <= 1'b0;
        next_q        <= Camera;
        state_q       <= pending_q ? Play : Camera;
      end
      Camera: begin
        pending_q     <= 1'b0;
        play_o        <= !control_q.steered;
        play_word_o   <= Cameras + {1'b0, camera_q, 4'd0};
        play_camera_o <= 1'b1;
        next_q        <= Start;
        state_q       <= control_q.steered ? Start : Play;
      end
      Start: begin
        valid_o <= control_q.run && !done_i;
        if (!control_q.run || done_i) begin
          new_frame_o <= control_q.run;
          frames_q    <= frames_q + 32'(control_q.run);
          state_q     <= Wait;
        end
      end
      // The player is busy from the clock after play_o on.
      default: if (!playing_i && !play_o) state_q <= next_q;
    endcase

    if (blanking) begin
      drain_o          <= 1'b1;
      late_led_q       <= 1'b0;
      underrun_frame_q <= 1'b0;
      underrun_led_q   <= underrun_frame_q;
    end
    if (new_frame_o) drain_o <= 1'b0;
    if (row_event_i && row_i.underrun && !drain_o) begin
      underruns_q      <= underruns_q + 1'b1;
      underrun_frame_q <= 1'b1;
    end

    // The orbit.
    if (turns) begin
      shown_q <= shown_q + 1'b1;
      if (shown_q + 9'd1 >= {1'b0, control_q.period}) shown_q <= '0;
    end
    if (steps || (turns && shown_q + 9'd1 >= {1'b0, control_q.period})) begin
      camera_q <= control_q.backward ? camera_q - 1'b1 : camera_q + 1'b1;
    end
    if (blanking && pressed[0]) control_q.turn <= !control_q.turn;
    if (blanking && pressed[1]) control_q.backward <= !control_q.backward;

    if (writes) begin
      case (register_i)
        4'd2: begin
          control_q <= '{
              period: register_data_i[15:8],
              scale: register_data_i[5:4],
              steered: register_data_i[3],
              backward: register_data_i[2],
              turn: register_data_i[1],
              run: register_data_i[0]
          };
        end
        4'd3: camera_q <= register_data_i[6:0];
        4'd4: begin
          list_q    <= register_data_i[TableBits-1:0];
          pending_q <= 1'b1;
        end
        default: ;
      endcase
    end

    requests_q     <= requests_q + 32'(events_i.request_done);
    bad_requests_q <= bad_requests_q + 32'(events_i.request_bad);
    refused_q      <= refused_q + 32'(events_i.write_refused);
    if (events_i.request_bad) bad_led_q <= 1'b1;

    unique case (register_i)
      4'd0:    register_data_o <= 32'h56584244;
      4'd1:    register_data_o <= {14'd0, 2'(LineBits - 4), 16'h0101};
      4'd2: begin
        register_data_o <= {
          16'd0, control_q.period, 2'd0, control_q.scale, control_q.steered, control_q.backward, control_q.turn,
          control_q.run
        };
      end
      4'd3:    register_data_o <= 32'(camera_q);
      4'd4:    register_data_o <= {pending_q, 31'd0};
      4'd5:    register_data_o <= frames_q;
      4'd6:    register_data_o <= underruns_q;
      4'd7:    register_data_o <= late_q;
      4'd8:    register_data_o <= requests_q;
      4'd9:    register_data_o <= bad_requests_q;
      4'd10:   register_data_o <= refused_q;
      4'd14:   register_data_o <= frame_crc_i;
      default: register_data_o <= 32'(ClockHz);
    endcase

    if (!rst_ni) begin
      state_q        <= Boot;
      play_o         <= 1'b0;
      valid_o        <= 1'b0;
      drain_o        <= 1'b1;
      control_q      <= '0;
      camera_q       <= '0;
      shown_q        <= '0;
      pending_q      <= 1'b0;
      frames_q       <= '0;
      underruns_q    <= '0;
      late_q         <= '0;
      requests_q     <= '0;
      bad_requests_q <= '0;
      refused_q      <= '0;
      late_led_q     <= 1'b0;
      bad_led_q      <= 1'b0;
      underrun_led_q <= 1'b0;
    end
  end

  always_comb begin
    access_o.write   = state_q == Start;
    access_o.address = state_q == Start ? CoreControl : CoreStatus;
    access_o.data    = 32'd1;
  end

  assign scale_o = control_q.scale;

  always_comb begin
    leds_o[0] = state_q != Boot && control_q.run;
    leds_o[1] = control_q.turn;
    leds_o[2] = control_q.backward;
    leds_o[3] = underrun_led_q;
    leds_o[4] = requests_q[0];
    leds_o[5] = bad_led_q;
    leds_o[6] = late_led_q;
    leds_o[7] = frames_q[5];
  end
endmodule
