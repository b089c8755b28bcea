#include "raplas/output_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace raplas {

OutputFile::OutputFile(const std::filesystem::path& target) : target_(target), written_(target) {
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(target, none);
  if (target.empty() || std::filesystem::is_directory(status)) {
    throw std::runtime_error(fmt::format("{}: is not the name of a file", target.string()));
  }
  if (std::filesystem::exists(status) && access(target.c_str(), W_OK) != 0) {
    fail("cannot be written");
  }
  const bool direct = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  if (!direct) {
    // A link stays a link: what it points to is replaced.
    written_ = std::filesystem::exists(status) ? std::filesystem::canonical(target) : target;
    target_ = written_;
    written_ += fmt::format(".part{}", getpid());
  }
  stream_ = std::fopen(written_.c_str(), direct ? "wb" : "wbx");
  if (stream_ == nullptr) {
    fail("cannot be written");
  }
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr) {
    std::fclose(stream_);
    if (written_ != target_) {
      std::error_code ignored;
      std::filesystem::remove(written_, ignored);
    }
  }
}

void OutputFile::fail(const char* what) const {
  throw std::runtime_error(fmt::format("{}: {} ({})", target_.string(), what, std::strerror(errno)));
}

void OutputFile::write(std::string_view data) {
  if (std::fwrite(data.data(), 1, data.size(), stream_) != data.size()) {
    fail("writing failed");
  }
}

void OutputFile::commit() {
  if (std::ferror(stream_) != 0 || std::fflush(stream_) != 0) {
    fail("writing failed");
  }
  if (written_ != target_) {
    if (fsync(fileno(stream_)) != 0) {
      fail("writing failed");
    }
    if (std::rename(written_.c_str(), target_.c_str()) != 0) {
      fail("cannot be replaced");
    }
  }
  std::FILE* stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) {
    fail("writing failed");
  }
}

}  // namespace raplas
