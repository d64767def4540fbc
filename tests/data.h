// Where the recorded test data lies.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace duo::test {

/// DUOPTIC_DATA, or beside the project; it may not exist.
inline std::filesystem::path data_folder() {
  const char* data = std::getenv("DUOPTIC_DATA");
  return data ? data : "../shared/data";
}

/// DUOPTIC_LONG: tests take every picture, every case and every moment of theirs, which is an hour and not minutes.
inline bool long_run() { return std::getenv("DUOPTIC_LONG") != nullptr; }

}  // namespace duo::test
