// raplas_trace_compare EXPECTED SEEN - the first difference between two cycle traces.
//
// Prints the clock, stage, field, expected and seen value and exits 1; exits 0 when the traces
// are equal, 2 when a file cannot be read. An x digit in EXPECTED is not compared; fields are
// found by name, and a field of EXPECTED that SEEN lacks is a difference, as is a missing clock.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Field {
  std::string name;
  std::string stage;
};

struct Line {
  std::string clock;
  std::map<std::string, std::string> values;
};

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> list;
  for (std::string word; stream >> word;) list.push_back(word);
  return list;
}

/// The fields of a header `# unit NAME clock name:width@stage ...`.
std::vector<Field> read_header(std::istream& file) {
  std::string line;
  std::getline(file, line);
  std::vector<Field> fields;
  const std::vector<std::string> list = words(line);
  for (std::size_t i = 4; i < list.size(); ++i) {
    const std::size_t at = list[i].find('@');
    fields.push_back({list[i].substr(0, list[i].find(':')), list[i].substr(at + 1)});
  }
  return fields;
}

bool read_line(std::istream& file, Line& line) {
  std::string text;
  if (!std::getline(file, text)) return false;
  const std::vector<std::string> list = words(text);
  line = {list.empty() ? "" : list[0], {}};
  for (std::size_t i = 1; i < list.size(); ++i) {
    const std::size_t equals = list[i].find('=');
    line.values[list[i].substr(0, equals)] = list[i].substr(equals + 1);
  }
  return true;
}

bool agree(const std::string& expected, const std::string& seen) {
  if (expected.size() != seen.size()) return false;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] != 'x' && expected[i] != seen[i]) return false;
  }
  return true;
}

int differ(const std::string& clock, const Field& field, const std::string& expected,
           const std::string& seen) {
  std::printf("first difference: clock %s, stage %s, field %s: expected %s, seen %s\n", clock.c_str(),
              field.stage.c_str(), field.name.c_str(), expected.c_str(), seen.c_str());
  return 1;
}

int compare(std::istream& expected_file, std::istream& seen_file) {
  const std::vector<Field> fields = read_header(expected_file);
  read_header(seen_file);
  const Field whole_line{"(line)", "-"};
  Line expected;
  Line seen;
  unsigned long digits = 0;  // that are not x in the expected trace
  for (unsigned long clocks = 0;; ++clocks) {
    const bool more = read_line(expected_file, expected);
    const bool more_seen = read_line(seen_file, seen);
    if (!more && !more_seen) {
      if (digits != 0) std::printf("equal: %lu clocks, %zu fields\n", clocks, fields.size());
      return digits == 0 ? differ("0", whole_line, "something", "nothing") : 0;
    }
    if (!more) return differ(seen.clock, whole_line, "the end", "a clock");
    if (!more_seen) return differ(expected.clock, whole_line, "a clock", "the end");
    if (expected.clock != seen.clock) return differ(expected.clock, whole_line, expected.clock, seen.clock);
    for (const Field& field : fields) {
      const auto value = seen.values.find(field.name);
      const std::string shown = value == seen.values.end() ? "(no such field)" : value->second;
      const std::string& wanted = expected.values[field.name];
      digits += static_cast<unsigned long>(wanted.size()) -
                static_cast<unsigned long>(std::count(wanted.begin(), wanted.end(), 'x'));
      if (!agree(wanted, shown)) {
        return differ(expected.clock, field, expected.values[field.name], shown);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: raplas_trace_compare EXPECTED SEEN\n");
    return 2;
  }
  std::ifstream expected(argv[1]);
  std::ifstream seen(argv[2]);
  if (!expected || !seen) {
    std::fprintf(stderr, "cannot read %s\n", expected ? argv[2] : argv[1]);
    return 2;
  }
  return compare(expected, seen);
}
