// Files that are there whole or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace raplas {

/// Writes to a new file in the target's folder, which commit() renames to the target; without commit() the
/// destructor removes it. A target that is no regular file (a device, a pipe) is written to directly.
/// All errors are std::runtime_error, one line naming the target and the cause.
class OutputFile {
 public:
  /// Opens the file, so that an unwritable target is found before the work that fills it.
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view data);
  /// For libraries that write themselves; commit() finds their errors.
  [[nodiscard]] std::FILE* stream() noexcept { return stream_; }
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }

  /// Makes the contents permanent; at most once.
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path target_;
  std::filesystem::path written_;  ///< the temporary file, or the target
  std::FILE* stream_ = nullptr;
};

}  // namespace raplas
