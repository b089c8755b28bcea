// Broken on purpose: what a dropped "when others" arm becomes in Yosys, a latch.
module latch_netlist
  (input  [1:0] select_i,
   input  d_i,
   output q_o);
  reg q_o;
  always @*
    case (select_i)
      2'b00: q_o <= d_i;
      2'b01: q_o <= ~d_i;
    endcase
endmodule
