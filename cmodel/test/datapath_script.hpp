// A datapath as formal/bounds/*.g.in describes it; the notation is that of formal/bounds.py.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace raplas {

struct DatapathScript {
  struct Operation {
    std::string name;
    std::string a;
    std::string operation;
    std::string b;
  };
  std::map<std::string, double> words;
  std::vector<Operation> operations;
  std::map<std::string, double> exact;
  std::vector<std::pair<std::vector<std::string>, double>> sums;
  std::vector<std::pair<std::vector<std::string>, double>> norms;

  explicit DatapathScript(const std::string& name) {
    std::ifstream file(std::filesystem::path(RAPLAS_BOUNDS) / (name + ".g.in"));
    EXPECT_TRUE(file.good()) << name;
    for (std::string line; std::getline(file, line);) {
      std::istringstream stream(line.substr(0, line.find('#')));
      std::vector<std::string> fields;
      for (std::string field; stream >> field;) {
        fields.push_back(field);
      }
      if (fields.empty() || fields[0] == "bound" || fields[0] == "error") {
        continue;
      }
      if (fields[0] == "sum" || fields[0] == "norm") {
        (fields[0] == "sum" ? sums : norms)
            .push_back({{fields.begin() + 1, fields.end() - 1}, std::stod(fields.back())});
        continue;
      }
      if (fields[0] == "word") {
        for (std::size_t k = 1; k + 1 < fields.size(); ++k) {
          words[fields[k]] = std::stod(fields.back());
        }
      } else if (fields[0] == "exact") {
        exact[fields[1]] = std::stod(fields[2]);
      } else {
        operations.push_back({fields[0], fields[2], fields[3], fields[4]});
      }
    }
  }

  /// A value as a term of words.
  [[nodiscard]] std::string term(const std::string& name) const {
    for (const Operation& o : operations) {
      if (o.name == name) {
        return "(" + term(o.a) + " " + o.operation + " " + term(o.b) + ")";
      }
    }
    EXPECT_TRUE(words.contains(name)) << name;
    return name;
  }
};

}  // namespace raplas
