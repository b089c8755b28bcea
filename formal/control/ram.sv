// ram: a read gives, two clocks later, the word that was written last at its address; what is written
// elsewhere, and when, doesn't matter. One address is chosen, any.
//
// Assumptions: none. A read in the clock of a write to its address, and a word never written, are not
// looked at.

(* anyconst *) reg [ADDRESS_BITS-1:0] address;

reg             written = 0;
reg [WIDTH-1:0] word;
reg [2:1]       asked = 0;   // k clocks ago
reg [WIDTH-1:0] expected1, expected2;
wire write_here = write_i && write_address_i == address;
always @(posedge clk_i) begin
  if (write_here) begin
    written <= 1;
    word    <= write_data_i;
  end
  asked     <= {asked[1], written && !write_here && read_address_i == address};
  expected1 <= word;
  expected2 <= expected1;
end

always @* begin
  read_back: assert (!asked[2] || read_data_o == expected2);

  // the registers
  in_memory: assert (!written || memory[address] == word);
  on_the_way: assert (!asked[1] || s1 == expected1);
  used: cover (asked[2] && word != expected2);
end
