// A rig file that must be refused with one line.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "duoptic/rig.h"

namespace duo::test {

/// The line names the file and holds `part`.
inline void expect_refused(const std::string& text, const std::string& part) {
  const auto rig = parse_rig(text, "my_rig.yaml");
  ASSERT_FALSE(rig) << "expected: " << part;
  EXPECT_NE(rig.error().what.find("my_rig.yaml"), std::string::npos) << rig.error().what;
  EXPECT_NE(rig.error().what.find(part), std::string::npos) << rig.error().what;
  EXPECT_EQ(rig.error().what.find('\n'), std::string::npos) << rig.error().what;
}

}  // namespace duo::test
