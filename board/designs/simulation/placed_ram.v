// A block RAM of the ECP5 (DP16KD), without output registers: 1,024 rows of 18 bits, of which a port sees words of its
// width; at 36 bits, port A writes and port B reads. What it holds at first comes from FILE.
module placed_ram #(
  parameter WIDTH_A = 18, parameter WIDTH_B = 18, parameter FILE = ""
) (
  input CLKA, input CEA, input WEA, input RSTA, input [13:0] ADA, input [17:0] DIA, output [17:0] DOA,
  input CLKB, input CEB, input WEB, input RSTB, input [13:0] ADB, input [17:0] DIB, output [17:0] DOB
);
  reg [17:0] rows [0:1023];
  reg [17:0] a_q, b_q;
  initial $readmemh(FILE, rows);
  assign DOA = a_q;
  assign DOB = b_q;

  // Where the bits of an access are in a row, and where they are at the pins.
  function [4:0] place(input integer width, input [13:0] address);
    case (width)
      1: place = {1'b0, address[3:0]} + {4'd0, address[3]};
      2: place = {1'b0, address[3:1], 1'b0} + {4'd0, address[3]};
      4: place = {1'b0, address[3:2], 2'b00} + {4'd0, address[3]};
      9: place = address[3] ? 5'd9 : 5'd0;
      default: place = 5'd0;
    endcase
  endfunction

  function [17:0] mask(input integer width, input [13:0] address);
    case (width)
      1, 2, 4, 9: mask = 18'((1 << width) - 1);
      default: mask = {{9{address[1]}}, {9{address[0]}}};
    endcase
  endfunction

  generate
    if (WIDTH_A == 36 || WIDTH_B == 36) begin : g_wide
      // Port A writes, port B reads; the low half is at DIA and DOA.
      if (WIDTH_A != 36 || WIDTH_B != 36) initial $error("two widths of one block RAM");
      wire [17:0] low = {{9{ADA[1]}}, {9{ADA[0]}}};
      wire [17:0] high = {{9{ADA[3]}}, {9{ADA[2]}}};
      always @(posedge CLKA) if (CEA && WEA) begin
        rows[{ADA[13:5], 1'b0}] <= (rows[{ADA[13:5], 1'b0}] & ~low) | (DIA & low);
        rows[{ADA[13:5], 1'b1}] <= (rows[{ADA[13:5], 1'b1}] & ~high) | (DIB & high);
      end
      always @(posedge CLKB) if (CEB) begin
        a_q <= rows[{ADB[13:5], 1'b0}];
        b_q <= rows[{ADB[13:5], 1'b1}];
      end
    end else begin : g_narrow
      always @(posedge CLKA) if (CEA) begin
        if (WEA) rows[ADA[13:4]] <= (rows[ADA[13:4]] & ~(mask(WIDTH_A, ADA) << place(WIDTH_A, ADA))) |
                                    ((DIA & mask(WIDTH_A, ADA)) << place(WIDTH_A, ADA));
        else a_q <= WIDTH_A == 18 ? rows[ADA[13:4]] : (rows[ADA[13:4]] >> place(WIDTH_A, ADA)) & 18'((1 << WIDTH_A) - 1);
      end
      always @(posedge CLKB) if (CEB) begin
        if (WEB) rows[ADB[13:4]] <= (rows[ADB[13:4]] & ~(mask(WIDTH_B, ADB) << place(WIDTH_B, ADB))) |
                                    ((DIB & mask(WIDTH_B, ADB)) << place(WIDTH_B, ADB));
        else b_q <= WIDTH_B == 18 ? rows[ADB[13:4]] : (rows[ADB[13:4]] >> place(WIDTH_B, ADB)) & 18'((1 << WIDTH_B) - 1);
      end
    end
  endgenerate
endmodule
