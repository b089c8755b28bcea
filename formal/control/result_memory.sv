// result_memory, its hit bits: from the clock after clear_i on no ray of the bank has a hit until it is written,
// then it has, until the next clear of that bank; hit_rows_o says of a row that a ray of it was written since that
// clear, so every row with a hit is there. Nothing that happens in the other banks or rows changes it. Both read
// ports show a hit bit two clocks after the address, as it was before the write and the clear of that clock.
// All rays of all banks; one is chosen, any. The other bits of a result are plain memory (ram.sv).
//
// Assumptions: none. Not looked at: a bank never cleared.

(* anyconst *) reg [BANK_BITS-1:0]   bank;
(* anyconst *) reg [LINE_BITS-1:0]   row, column;
wire [2*LINE_BITS-1:0] ray = {row, column};

wire this_clear = clear_i && clear_bank_i == bank;
wire write_here = write_i && write_bank_i == bank && write_ray_i == ray;
wire write_row  = write_i && write_bank_i == bank && write_ray_i[2*LINE_BITS-1:LINE_BITS] == row;
reg         defined = 0;  // the bank was cleared
reg         hit;          // the ray was written since
reg         row_hit;      // a ray of its row was
reg         forgotten = 0;            // there was a hit before the last clear
reg [2:1]   best_asked = 0, host_asked = 0;  // k clocks ago
reg [2:1]   hit_then;

always @(posedge clk_i) begin
  if (this_clear) begin
    defined   <= 1;
    hit       <= 0;
    row_hit   <= 0;
    forgotten <= defined && hit;
  end else begin
    if (write_here) hit <= 1;
    if (write_row) row_hit <= 1;
  end
  best_asked <= {best_asked[1], defined && best_bank_i == bank && best_ray_i == ray};
  host_asked <= {host_asked[1], defined && host_ray_i == {bank, ray}};
  hit_then   <= {hit_then[1], hit};
end

always @* begin
  best: assert (!best_asked[2] || best_hit[1] == hit_then[2]);
  host: assert (!host_asked[2] || host_hit[1] == hit_then[2]);
  flag: assert (!defined || hit_rows_o[{bank, row}] == row_hit);
  shown: assert (!(defined && hit) || hit_rows_o[{bank, row}]);

  // the registers
  stored: assert (!(defined && row_hit) || stored_hit == hit);
  best_on_the_way: assert (!best_asked[1] || best_hit[0] == hit_then[1]);
  host_on_the_way: assert (!host_asked[1] || host_hit[0] == hit_then[1]);
  seen: cover (host_asked[2] && hit_then[2] && best_asked[2]);
  again: cover (host_asked[2] && !hit_then[2] && forgotten && row_hit && row == MAX_ROWS - 1);
end
wire [MAX_COLUMNS-1:0] row_hits = hits[{bank, row}];
wire stored_hit = row_hits[column];
