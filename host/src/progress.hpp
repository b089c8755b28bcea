// How far a rendering is, on stderr.
#pragma once

#include <string>

namespace raplas {

/// A bar that moves if stderr is a terminal, otherwise a line every 10 %.
class Progress {
 public:
  Progress(std::string name, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `share` of the work is done, 0 .. 1.
  void show(double share);

 private:
  std::string name_;
  bool quiet_;
  bool terminal_;
  int shown_ = 0;  ///< per cent
};

}  // namespace raplas
