// A text with something else at one place, for files that are almost right.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace duo::test {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

}  // namespace duo::test
