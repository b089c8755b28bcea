// result_memory, its hit bits: clearing_o lasts MAX_ROWS clocks without a write after clear_i; after it every
// ray of the bank has no hit until it is written, then it has, until the next clear of that bank. Nothing that
// happens in the other banks changes it. Both read ports show that two clocks after the address.
// All rays of all banks; one is chosen, any. The other bits of a result are plain memory (ram.sv).
//
// Assumptions: reset in the first clock; no other clear while clearing_o; no write into the bank that is being
// cleared, from clear_i on. Not looked at: reads of the bank that is being cleared, reads in the clock of a
// write to that ray, and a bank never cleared.

localparam HIT = RESULT_BITS - 1;

reg started = 0;
(* anyconst *) reg [BANK_BITS-1:0]   bank;
(* anyconst *) reg [LINE_BITS-1:0]   row, column;
wire [2*LINE_BITS-1:0] ray = {row, column};

wire this_clear = clear_i && clear_bank_i == bank;
wire write_here = write_i && write_bank_i == bank && write_ray_i == ray;
reg         defined = 0;  // the bank was cleared
reg         hit;
reg [LINE_BITS:0] age = MAX_ROWS;  // rows cleared since clear_i
reg [BANK_BITS-1:0] was_bank;      // the last one cleared
reg [2:1]   best_asked = 0, host_asked = 0;  // k clocks ago
reg [2:1]   hit_then;
wire readable = defined && !write_here && !this_clear && !(clearing_o && was_bank == bank);

always @(posedge clk_i) begin
  started   <= 1;
  was_bank  <= clear_i ? clear_bank_i : was_bank;
  age       <= rst_i ? MAX_ROWS : clear_i ? 0 : age == MAX_ROWS || write_i ? age : age + 1;
  if (this_clear) begin
    defined <= 1;
    hit     <= 0;
  end else if (write_here) hit <= 1;
  if (rst_i) defined <= 0;
  best_asked <= {best_asked[1] && started, started && readable && best_bank_i == bank && best_ray_i == ray};
  host_asked <= {host_asked[1] && started, started && readable && host_ray_i == {bank, ray}};
  hit_then   <= {hit_then[1], hit};
end

always @* begin
  assume (started || rst_i);
  if (clearing_o) assume (!clear_i && !(write_i && write_bank_i == was_bank));
  if (clear_i) assume (!(write_i && write_bank_i == clear_bank_i));
  if (started) begin
    duration: assert (clearing_o == (age < MAX_ROWS));
    best: assert (!best_asked[2] || best_hit[1] == hit_then[2]);
    host: assert (!host_asked[2] || host_hit[1] == hit_then[2]);

    // the registers
    progress: assert (age <= MAX_ROWS);
    at_row: assert (age == MAX_ROWS || clear_row == age[LINE_BITS-1:0] && clear_bank == was_bank);
    stored: assert (!defined || stored_hit == hit || clearing_o && was_bank == bank && age <= row);
    blank: assert (!(clearing_o && was_bank == bank && defined) || !hit);
    best_on_the_way: assert (!best_asked[1] || best_hit[0] == hit_then[1]);
    host_on_the_way: assert (!host_asked[1] || host_hit[0] == hit_then[1]);
  end
  seen: cover (started && host_asked[2] && hit_then[2] && best_asked[2]);
  again: cover (started && host_asked[2] && !hit_then[2] && row == MAX_ROWS - 1);
end
wire [MAX_COLUMNS-1:0] row_hits = hits[{bank, row}];
wire stored_hit = row_hits[column];
