// The main of every test program: PROGRAM [FILE_test.cpp...] runs the tests of these files, all without. A program whose every
// test was skipped returns 77, which ctest shows as skipped; one with a failure never does.
#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

namespace {
// A filter for the tests of these files without those that `left_out`, a filter that only says what not to run, names; empty
// when a file has none.
std::string tests_of(const std::vector<std::string>& files, const std::string& left_out) {
  std::string filter;
  const auto& all = *::testing::UnitTest::GetInstance();
  for (const std::string& file : files) {
    bool found = false;
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
      const auto& suite = *all.GetTestSuite(s);
      for (int t = 0; t < suite.total_test_count(); ++t) {
        const auto& test = *suite.GetTestInfo(t);
        if (test.file() != file) continue;
        filter += std::string(suite.name()) + "." + test.name() + ":";
        found = true;
      }
    }
    if (!found) return {};
  }
  return filter + left_out;
}
}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const std::string filter = ::testing::GTEST_FLAG(filter);
  const bool names_tests = filter != "*" && !filter.starts_with('-');  // who names tests wants these
  if (argc > 1 && !names_tests) {
    ::testing::GTEST_FLAG(filter) = tests_of({argv + 1, argv + argc}, filter == "*" ? "" : filter);
    if (::testing::GTEST_FLAG(filter).empty()) {
      std::cerr << "no test is in one of the files named; this program has those of its group\n";
      return 1;
    }
  }
  const int result = RUN_ALL_TESTS();
  const auto& all = *::testing::UnitTest::GetInstance();
  const bool only_skipped = all.skipped_test_count() > 0 && all.successful_test_count() == 0;
  constexpr int kSkipped = 77;
  return result == 0 && only_skipped ? kSkipped : result;
}
