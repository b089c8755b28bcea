// What every program of the host does around its work: command line, errors, exit codes.
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace raplas {

/// Parses the command line. Returns an exit code if that was all: 0 after help, 2 for a wrong command line.
[[nodiscard]] std::optional<int> parse(CLI::App& app, int argc, char** argv);

/// The command line as one text, for figures files.
[[nodiscard]] std::string command_line(const CLI::App& app, int argc, char** argv);

/// main() of a program: what `run` returns, or 1 for an exception, with one line on stderr.
int run_program(const char* name, int argc, char** argv, int (*run)(int, char**));

}  // namespace raplas
