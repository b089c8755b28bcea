#include "parallel.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace raplas {

void for_each_parallel(std::size_t count, const std::function<void(std::size_t)>& work,
                       const ShowProgress& progress) {
  std::mutex mutex;  // of all below
  std::size_t next = 0;
  std::size_t done = 0;
  std::exception_ptr error;
  const auto run = [&] {
    std::unique_lock lock(mutex);
    while (next < count && !error) {
      const std::size_t mine = next++;
      lock.unlock();
      std::exception_ptr thrown;
      try {
        work(mine);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      if (thrown) {
        error = thrown;
        return;
      }
      progress(static_cast<double>(++done) / static_cast<double>(count));
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t helpers = std::max(1U, std::thread::hardware_concurrency()) - 1;
    for (std::size_t k = 0; k < std::min(helpers, count); ++k) {
      threads.emplace_back(run);
    }
    run();
  }
  if (error) {
    std::rethrow_exception(error);
  }
}

}  // namespace raplas
