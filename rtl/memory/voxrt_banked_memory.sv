// The octree memory once for all lanes, in sixteen banks of dual-port block RAM: for scenes that would not fit the
// block RAM in a copy per two lanes. The words of a block are in different banks, those of blocks that are 16 apart in
// different orders, so that lanes near the root do not all want one bank: a bank's row holds the word {row, bank ^
// lowest bits of row}.
//
// The first 256 blocks, which is the octree's top where blocks are ordered breadth-first, are in private copies as
// well, a RAMB36 per two lanes: near the root, where all rays pass, lanes do not meet. Of a Menger sponge of 128 voxels
// per side, one request in 8 would be refused without these copies, and one in 117 is with them. (Of a memory of few
// blocks, a quarter is in copies.)
//
// Each bank serves two lanes per clock: the first that asks from a rotating start upwards, and the last. The others get
// no ack_o and ask again when their rays come round, even for a word that another lane gets: a ray reads a word but
// once, so that no word can be in demand more than once per pixel. A word comes five clocks after its address:
//   0 choose lanes | 1 their rows | 2 block RAM | 3 its output register | 4 to the lanes
//
// The access port takes port A of its bank; when it writes to the top, it takes port A of every copy.
module voxrt_banked_memory
  import voxrt_pkg::*;
#(
  parameter int unsigned Lanes     = 16,
  parameter int unsigned BlockBits = 12,
  parameter bit          Lod       = 1'b0
) (
  input  logic                                  clk_i,
  input  logic                                  rst_ni,
  input  logic                                  access_i,
  input  logic                                  access_write_i,
  input  logic [                 BlockBits+2:0] access_address_i,
  input  logic [payload_bits(BlockBits, Lod):0] access_word_i,
  output logic [payload_bits(BlockBits, Lod):0] access_word_o,            // Five clocks later.
  input  logic [                     Lanes-1:0] read_i,
  input  logic [                 BlockBits+2:0] address_i       [Lanes],
  output logic [                     Lanes-1:0] ack_o,
  output logic [payload_bits(BlockBits, Lod):0] word_o          [Lanes]
);
  localparam int unsigned PayloadBits = payload_bits(BlockBits, Lod);
  localparam int unsigned AddressBits = BlockBits + 3;
  localparam int unsigned BankBits = 4;
  localparam int unsigned Banks = 2 ** BankBits;
  localparam int unsigned BankRowBits = AddressBits - BankBits;
  localparam int unsigned LaneBits = Lanes > 1 ? $clog2(Lanes) : 1;

  // The first blocks.
  localparam int unsigned TopBlockBits = BlockBits < 10 ? BlockBits - 2 : 8;
  localparam int unsigned TopRowBits = TopBlockBits + 3 - BankBits;

  // Bank and row in it of each lane's request, clock by clock.
  logic [BankBits-1:0] bank[Lanes];
  logic [BankBits-1:0] bank_q[1:4][Lanes];
  logic [BankRowBits-1:0] row[Lanes];
  logic [BankRowBits-1:0] row_q[1:2][Lanes];
  logic [Lanes-1:0] in_top, in_top_q[1:2], asks;

  always_comb begin
    for (int unsigned i = 0; i < Lanes; i++) begin
      in_top[i] = address_i[i][AddressBits-1:TopBlockBits+3] == '0;
      asks[i]   = read_i[i] && !in_top[i];
      row[i]    = address_i[i][AddressBits-1:BankBits];
      bank[i]   = address_i[i][BankBits-1:0] ^ row[i][BankBits-1:0];
    end
  end

  always_ff @(posedge clk_i) begin
    in_top_q[1] <= rst_ni ? read_i & in_top : '0;
    in_top_q[2] <= rst_ni ? in_top_q[1] : '0;
    bank_q[1]   <= bank;
    bank_q[2]   <= bank_q[1];
    bank_q[3]   <= bank_q[2];
    bank_q[4]   <= bank_q[3];
    row_q[1]    <= row;
    row_q[2]    <= row_q[1];
  end

  // The access port, kept in step.
  logic access_q[1:2];
  logic access_write_q[1:2];
  logic [BankRowBits-1:0] access_row_q[1:2];
  logic [BankBits-1:0] access_bank_q[1:4];
  logic [PayloadBits:0] access_word_q[1:2];

  always_ff @(posedge clk_i) begin
    // No reset: a reset of the core drops rays, and no word that the processor writes or reads.
    access_q[1]       <= access_i;
    access_q[2]       <= access_q[1];
    access_write_q[1] <= access_write_i;
    access_write_q[2] <= access_write_q[1];
    access_row_q[1]   <= access_address_i[AddressBits-1:BankBits];
    access_row_q[2]   <= access_row_q[1];
    access_bank_q[1]  <= access_address_i[BankBits-1:0] ^ access_address_i[2*BankBits-1:BankBits];
    access_word_q[1]  <= access_word_i;
    access_word_q[2]  <= access_word_q[1];
    for (int unsigned s = 2; s <= 4; s++) access_bank_q[s] <= access_bank_q[s-1];
  end

  // 0 choose: a lane is the first, or the last, of those that ask its bank. Lanes from the rotating start on go before
  // the others.
  logic [Lanes-1:0] late_q, first, last, first_q, last_q;
  logic [Lanes-1:0] same_bank[Lanes], in_bank_q[Banks];

  function automatic logic is_before(int unsigned i, int unsigned j, logic i_late, logic j_late);
    return i_late == j_late ? i < j : j_late;
  endfunction

  always_comb begin
    first = asks;
    last  = asks;
    for (int unsigned i = 0; i < Lanes; i++) begin
      for (int unsigned j = 0; j <= i; j++) begin
        same_bank[i][j] = asks[i] && asks[j] && bank[i] == bank[j];
        same_bank[j][i] = same_bank[i][j];
      end
    end
    for (int unsigned i = 0; i < Lanes; i++) begin
      for (int unsigned j = 0; j < Lanes; j++) begin
        if (same_bank[i][j] && j != i && is_before(j, i, late_q[j], late_q[i])) first[i] = 1'b0;
        if (same_bank[i][j] && j != i && is_before(i, j, late_q[i], late_q[j])) last[i] = 1'b0;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    late_q  <= !rst_ni || late_q[Lanes-1] ? '0 : Lanes'({late_q, 1'b1});
    first_q <= rst_ni ? first : '0;
    last_q  <= rst_ni ? last : '0;
    for (int unsigned k = 0; k < Banks; k++) begin
      for (int unsigned i = 0; i < Lanes; i++) in_bank_q[k][i] <= bank[i] == BankBits'(k);
    end
  end

  // 1 rows; 2 block RAM.
  logic [PayloadBits:0] a_word[Banks], b_word[Banks];

  // Zero for no lane.
  function automatic logic [LaneBits-1:0] number_of(logic [Lanes-1:0] lane);
    number_of = '0;
    for (int unsigned i = 0; i < Lanes; i++) if (lane[i]) number_of |= LaneBits'(i);
  endfunction

  for (genvar k = 0; k < Banks; k++) begin : gen_bank
    logic accessed, accessed2_q;
    logic [BankRowBits-1:0] a_row2_q, b_row2_q;

    assign accessed = access_q[1] && access_bank_q[1] == BankBits'(k);

    always_ff @(posedge clk_i) begin
      accessed2_q <= accessed;
      a_row2_q    <= accessed ? access_row_q[1] : row_q[1][number_of(first_q&in_bank_q[k])];
      b_row2_q    <= row_q[1][number_of(last_q&in_bank_q[k])];
    end

    voxrt_block_ram #(
      .Width(PayloadBits + 1),
      .Depth(2 ** BankRowBits)
    ) u_ram (
      .clk_i,
      .a_read_i (1'b1),
      .a_write_i(accessed2_q && access_write_q[2]),
      .a_row_i  (a_row2_q),
      .a_data_i (access_word_q[2]),
      .a_data_o (a_word[k]),
      .b_read_i (1'b1),
      .b_row_i  (b_row2_q),
      .b_data_o (b_word[k])
    );
  end

  // 2 the top: the row of a word is made of its row in its bank and the bank.
  logic [TopBlockBits+2:0] top_address[Lanes];
  logic [Lanes-1:0] from_top;
  logic [PayloadBits:0] top_word[Lanes], unused_top_access;
  logic writes_top;

  assign writes_top = access_q[2] && access_write_q[2] && access_row_q[2][BankRowBits-1:TopRowBits] == '0;

  always_comb begin
    for (int unsigned i = 0; i < Lanes; i++) begin
      top_address[i] = {row_q[2][i][TopRowBits-1:0], bank_q[2][i]};
    end
  end

  voxrt_private_memory #(
    .Lanes      (Lanes),
    .AddressBits(TopBlockBits + 3),
    .PayloadBits(PayloadBits)
  ) u_top (
    .clk_i,
    .rst_ni,
    .access_i        (writes_top),
    .access_write_i  (1'b1),
    .access_address_i({access_row_q[2][TopRowBits-1:0], access_bank_q[2]}),
    .access_word_i   (access_word_q[2]),
    .access_word_o   (unused_top_access),
    .read_i          (in_top_q[2]),
    .address_i       (top_address),
    .ack_o           (from_top),
    .word_o          (top_word)
  );

  // 4 to the lanes.
  logic [Lanes-1:0] from_a_q[2:4], from_b_q[2:4], ack_q;
  logic [PayloadBits:0] word_q[Lanes], access_out_q;

  always_ff @(posedge clk_i) begin
    for (int unsigned i = 0; i < Lanes; i++) begin
      from_a_q[2][i] <= first_q[i] && !(access_q[1] && access_bank_q[1] == bank_q[1][i]);
      word_q[i]      <= from_top[i] ? top_word[i] : from_a_q[4][i] ? a_word[bank_q[4][i]] : b_word[bank_q[4][i]];
    end
    from_a_q[3]  <= from_a_q[2];
    from_a_q[4]  <= from_a_q[3];
    from_b_q[2]  <= last_q;
    from_b_q[3]  <= from_b_q[2];
    from_b_q[4]  <= from_b_q[3];
    ack_q        <= from_a_q[4] | from_b_q[4] | from_top;
    access_out_q <= a_word[access_bank_q[4]];
    if (!rst_ni) begin
      from_a_q <= '{default: '0};
      from_b_q <= '{default: '0};
      ack_q    <= '0;
    end
  end

  assign ack_o         = ack_q;
  assign word_o        = word_q;
  assign access_word_o = access_out_q;
endmodule
