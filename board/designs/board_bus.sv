// Joins two masters, one access at a time, to all that the address map has: the core's registers, its octree memory,
// the board's registers, the table.
//
// A master holds valid_i and its access until done_o, which is set for one clock. Master 0 goes first.
module board_bus
  import board_pkg::*;
#(
  parameter int unsigned MemoryClocks = 3  // Clocks from an address of the octree memory to its word: 2 or more.
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic    [          1:0] valid_i,
  input  access_t [          1:0] access_i,
  output logic    [          1:0] done_o,
  output logic    [         31:0] data_o,            // What was read, with done_o.
  output logic                    refused_o,         // Nothing has this address, with done_o.
  // The core's registers.
  output logic                    m_axil_awvalid,
  input  logic                    m_axil_awready,
  output logic    [         10:0] m_axil_awaddr,
  output logic                    m_axil_wvalid,
  input  logic                    m_axil_wready,
  output logic    [         31:0] m_axil_wdata,
  input  logic                    m_axil_bvalid,
  input  logic    [          1:0] m_axil_bresp,
  output logic                    m_axil_arvalid,
  input  logic                    m_axil_arready,
  output logic    [         10:0] m_axil_araddr,
  input  logic                    m_axil_rvalid,
  input  logic    [         31:0] m_axil_rdata,
  input  logic    [          1:0] m_axil_rresp,
  // The octree memory.
  output logic                    memory_en_o,
  output logic                    memory_write_o,
  output logic    [         31:0] memory_address_o,
  output logic    [         31:0] memory_data_o,
  input  logic    [         31:0] memory_data_i,
  // The board's registers: what they read comes a clock later.
  output logic                    register_en_o,
  output logic                    register_write_o,
  output logic    [          3:0] register_o,
  output logic    [         31:0] register_data_o,
  input  logic    [         31:0] register_data_i,
  // The table: what it reads comes two clocks later.
  output logic                    table_write_o,
  output logic    [TableBits-1:0] table_word_o,
  output logic    [         31:0] table_data_o,
  input  logic    [         31:0] table_data_i
);
  if (MemoryClocks < 2) $error("board_bus: MemoryClocks must be 2 clocks or more");

  typedef enum logic [2:0] {
    Idle,
    Begin,
    Core,
    Wait,
    Done
  } state_e;

  typedef enum logic [2:0] {
    CoreRegisters,
    BoardRegisters,
    Table,
    Memory,
    Nothing
  } target_e;

  state_e state_q;
  target_e target_q;
  logic master_q, refused_q;
  logic [1:0] asks;
  access_t access, access_q;
  logic [2:0] wait_q;
  logic [31:0] data_q;

  // A master lowers valid_i a clock after done_o.
  assign asks   = valid_i & ~done_o;
  assign access = asks[0] ? access_i[0] : access_i[1];

  function automatic target_e target_of(logic [23:0] address);
    if (address[1:0] != '0) return Nothing;
    if (address[23]) return Memory;
    if (address[22:11] == '0) return CoreRegisters;
    if (address[22:6] == 17'h040) return address[5:2] inside {4'd12, 4'd13, 4'd15} ? Nothing : BoardRegisters;
    if (address[22:14] == 9'd1) return Table;
    return Nothing;
  endfunction

  always_ff @(posedge clk_i) begin
    done_o        <= '0;
    memory_en_o   <= 1'b0;
    register_en_o <= 1'b0;
    table_write_o <= 1'b0;
    unique case (state_q)
      Idle: begin
        if (asks != '0) begin
          master_q <= !asks[0];
          access_q <= access;
          target_q <= target_of(access.address);
          state_q  <= Begin;
        end
      end
      Begin: begin
        refused_q <= target_q == Nothing;
        data_q    <= '0;
        wait_q    <= 3'd2;
        state_q   <= Wait;
        unique case (target_q)
          CoreRegisters: begin
            m_axil_awvalid <= access_q.write;
            m_axil_wvalid  <= access_q.write;
            m_axil_arvalid <= !access_q.write;
            state_q        <= Core;
          end
          BoardRegisters: register_en_o <= 1'b1;
          Table: table_write_o <= access_q.write;
          Memory: begin
            memory_en_o <= 1'b1;
            wait_q      <= 3'(MemoryClocks);
          end
          default: state_q <= Done;
        endcase
      end
      Core: begin
        if (m_axil_awready) m_axil_awvalid <= 1'b0;
        if (m_axil_wready) m_axil_wvalid <= 1'b0;
        if (m_axil_arready) m_axil_arvalid <= 1'b0;
        if (m_axil_bvalid || m_axil_rvalid) begin
          refused_q <= m_axil_bvalid ? m_axil_bresp != '0 : m_axil_rresp != '0;
          data_q    <= m_axil_rdata;
          state_q   <= Done;
        end
      end
      Wait: begin
        wait_q <= wait_q - 3'd1;
        if (wait_q == '0) begin
          unique case (target_q)
            BoardRegisters: data_q <= register_data_i;
            Memory:         data_q <= memory_data_i;
            default:        data_q <= table_data_i;
          endcase
          state_q <= Done;
        end
      end
      default: begin
        done_o[master_q] <= 1'b1;
        data_o           <= refused_q ? '0 : data_q;
        refused_o        <= refused_q;
        state_q          <= Idle;
      end
    endcase
    if (!rst_ni) begin
      state_q        <= Idle;
      done_o         <= '0;
      memory_en_o    <= 1'b0;
      register_en_o  <= 1'b0;
      table_write_o  <= 1'b0;
      m_axil_awvalid <= 1'b0;
      m_axil_wvalid  <= 1'b0;
      m_axil_arvalid <= 1'b0;
    end
  end

  assign m_axil_awaddr    = access_q.address[10:0];
  assign m_axil_araddr    = access_q.address[10:0];
  assign m_axil_wdata     = access_q.data;
  assign memory_write_o   = access_q.write;
  assign memory_address_o = {9'd0, access_q.address[22:0]};
  assign memory_data_o    = access_q.data;
  assign register_write_o = access_q.write;
  assign register_o       = access_q.address[5:2];
  assign register_data_o  = access_q.data;
  assign table_word_o     = access_q.address[TableBits+1:2];
  assign table_data_o     = access_q.data;
endmodule
