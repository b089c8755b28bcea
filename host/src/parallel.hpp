// Independent pieces of work on all of the machine's threads.
#pragma once

#include <cstddef>
#include <functional>

namespace raplas {

/// Share of a piece of work done, 0 .. 1.
using ShowProgress = std::function<void(double)>;

/// Calls work(k) once for each k below `count`, in any order and several at a time: each call writes what is
/// its own only. `progress` is called by one thread at a time. What a call throws ends the work and is thrown
/// here.
void for_each_parallel(std::size_t count, const std::function<void(std::size_t)>& work,
                       const ShowProgress& progress);

}  // namespace raplas
