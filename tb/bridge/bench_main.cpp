// main of every bench: GoogleTest's options, traces and waves.
//
// Exit code: GoogleTest's; 1 too when tests ran but count_checked() was never told of a result.
#include <gtest/gtest.h>

#include <cstdio>
#include <string_view>

#include "bridge/checked.hpp"
#include "bridge/dut.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  for (int i = 1; i < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--trace" && i + 1 < argc) {
      raplas::dut().trace_to(argv[i + 1]);
    } else if (option == "--trace-expected" && i + 1 < argc) {
      raplas::dut().trace_expected_to(argv[i + 1]);
    } else if (option == "--waves" && i + 1 < argc) {
      raplas::Dut::waves_to(argv[i + 1]);
    } else {
      std::fprintf(stderr,
                   "usage: %s [--trace FILE] [--trace-expected FILE] [--waves FILE] [GoogleTest's options]\n",
                   argv[0]);
      return 2;
    }
  }
  const int failed = RUN_ALL_TESTS();
  raplas::dut().trace_line();
  if (testing::GTEST_FLAG(list_tests)) return failed;
  std::printf("%s in %s: %llu results checked in %llu cycles\n", raplas::Dut::unit().data(),
              raplas::Dut::simulator().data(), static_cast<unsigned long long>(raplas::checked()),
              static_cast<unsigned long long>(raplas::dut().cycles()));
  if (raplas::checked() == 0) {
    std::fprintf(stderr, "nothing was checked: that is a failure\n");
    return 1;
  }
  return failed;
}
