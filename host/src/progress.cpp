#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace raplas {

Progress::Progress(std::string name, bool quiet)
    : name_(std::move(name)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (!quiet_ && terminal_ && shown_ > 0) {
    std::fputc('\n', stderr);
  }
}

void Progress::show(double share) {
  const int percent = static_cast<int>(share * 100);
  const int step = terminal_ ? 1 : 10;
  if (quiet_ || percent < shown_ + step) {
    return;
  }
  shown_ = percent - percent % step;
  if (terminal_) {
    constexpr int kWidth = 40;
    const int filled = percent * kWidth / 100;
    fmt::print(stderr, "\r{:<9} [{:#<{}}{: <{}}] {:3} %", name_, "", filled, "", kWidth - filled, percent);
    std::fflush(stderr);
  } else {
    fmt::print(stderr, "{}: {} %\n", name_, shown_);
  }
}

}  // namespace raplas
