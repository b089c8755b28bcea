// block_fifo: of a queue (queue.sv) a word is shown as soon as those before it are gone, but not in the
// clock after its write.

// all but a word written in the last clock
reg fresh = 0;
always @(posedge clk_i) fresh <= accepted && !rst_i;

always @* begin
  if (started) begin
    not_empty: assert (valid_o == (inside > fresh));
    fresh_is_inside: assert (inside >= fresh);
    shown: assert (!valid_o || data_o == memory[head]);
  end
end
