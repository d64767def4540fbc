// The main of every test program. A program whose every test was skipped returns 77, which ctest shows as skipped; one with a
// failure never does.
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  const auto& all = *::testing::UnitTest::GetInstance();
  const bool only_skipped = all.skipped_test_count() > 0 && all.successful_test_count() == 0;
  constexpr int kSkipped = 77;
  return result == 0 && only_skipped ? kSkipped : result;
}
