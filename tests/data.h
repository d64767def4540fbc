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

}  // namespace duo::test
