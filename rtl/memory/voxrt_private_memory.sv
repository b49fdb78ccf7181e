// The octree memory as private copies, for the shortest path from address to word: two lanes share a copy, one at each
// port of its block RAMs. A word comes two clocks after its address.
//
// Word 1 + a of the octree is in row a; word 0 is elsewhere (voxrt_octree_memory).
//
// The access port has port A: of all copies to write, of the first one to read. It never waits. At such a clock, both
// lanes share port B: a lane that is refused gets no ack_o and asks again. Each lane is preferred for 8 clocks of 16,
// which are half of the passes of every ray, in a ring of 12 stages as of 15: so each ray keeps at least half of its
// reads, even if the processor uses the port at every clock.
module voxrt_private_memory #(
  parameter int unsigned Lanes       = 1,
  parameter int unsigned AddressBits = 15,  // 2**AddressBits words: 1 or more.
  parameter int unsigned PayloadBits = 12,  // Bits of a word besides the highest: 9 or more.
  parameter string       File        = ""   // For $readmemh: a row per line, encoded.
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   access_i,
  input  logic                   access_write_i,
  input  logic [AddressBits-1:0] access_address_i,
  input  logic [  PayloadBits:0] access_word_i,
  output logic [  PayloadBits:0] access_word_o,            // Two clocks later.
  input  logic [      Lanes-1:0] read_i,
  input  logic [AddressBits-1:0] address_i       [Lanes],
  output logic [      Lanes-1:0] ack_o,
  output logic [  PayloadBits:0] word_o          [Lanes]
);
  if (AddressBits < 1) $error("voxrt_private_memory: AddressBits must be 1 bit or more");
  if (PayloadBits < 9) $error("voxrt_private_memory: PayloadBits must be 9 bits or more");

  localparam int unsigned Copies = (Lanes + 1) / 2;

  logic [3:0] count_q;
  logic prefers_even;
  logic [Lanes-1:0] accepted, accepted_q, ack_q;

  assign prefers_even = count_q[3];

  always_ff @(posedge clk_i) begin
    count_q    <= count_q + 1'b1;
    accepted_q <= accepted;
    ack_q      <= accepted_q;
    if (!rst_ni) begin
      count_q    <= '0;
      accepted_q <= '0;
      ack_q      <= '0;
    end
  end

  assign ack_o = ack_q;

  for (genvar c = 0; c < Copies; c++) begin : gen_copy
    localparam int unsigned Even = 2 * c;
    localparam bit Paired = Even + 1 < Lanes;
    localparam int unsigned Odd = Paired ? Even + 1 : Even;

    logic accessed, odd_reads, swaps, swapped1_q, swapped2_q;
    logic [PayloadBits:0] a_word, b_word;

    assign accessed       = access_i && (access_write_i || c == 0);
    assign odd_reads      = Paired && read_i[Odd];

    // Port B serves the even lane.
    assign swaps          = accessed && read_i[Even] && (prefers_even || !odd_reads);
    assign accepted[Even] = read_i[Even] && (!accessed || swaps);
    assign word_o[Even]   = swapped2_q ? b_word : a_word;

    always_ff @(posedge clk_i) begin
      swapped1_q <= swaps;
      swapped2_q <= swapped1_q;
    end

    if (Paired) begin : gen_odd
      assign accepted[Odd] = odd_reads && !swaps;
      assign word_o[Odd]   = b_word;
    end
    if (c == 0) begin : gen_access
      assign access_word_o = a_word;
    end

    voxrt_block_ram #(
      .Width(PayloadBits + 1),
      .Depth(2 ** AddressBits),
      .File (File)
    ) u_ram (
      .clk_i,
      .a_read_i (read_i[Even] || accessed),
      .a_write_i(accessed && access_write_i),
      .a_row_i  (accessed ? access_address_i : address_i[Even]),
      .a_data_i (access_word_i),
      .a_data_o (a_word),
      .b_read_i (odd_reads || swaps),
      .b_row_i  (swaps ? address_i[Even] : address_i[Odd]),
      .b_data_o (b_word)
    );
  end
endmodule
