// fifo: of a queue (queue.sv) that isn't empty the front word is shown.

always @* if (started) not_empty: assert (valid_o == (inside != 0));
