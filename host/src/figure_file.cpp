#include "figure_file.hpp"

#include <utility>

namespace raplas {

FigureFile::FigureFile(const std::filesystem::path& file, std::string command)
    : command_(std::move(command)) {
  if (!file.empty()) {
    file_.emplace(file);
  }
}

void FigureFile::commit() {
  if (file_) {
    file_->write(figures_.dump(2) + "\n");
    file_->commit();
  }
}

double per(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? 0 : static_cast<double>(count) / static_cast<double>(of);
}

double percent(std::uint64_t count, std::uint64_t of) {
  return of == 0 ? 0 : 100 * static_cast<double>(count) / static_cast<double>(of);
}

}  // namespace raplas
