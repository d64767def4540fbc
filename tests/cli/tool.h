// The tool run from outside.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/write_media.h"

namespace duo::test {

inline constexpr int kUsage = 2, kCut = 3, kInput = 4, kOutput = 5;  // what duoptic exits with (docs of each command)

struct Ended {
  int exit = -1;  // 128 + the signal that ended it
  std::string out, err;
  nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// Runs duoptic with these arguments in `folder`; `before` is shell, for limits.
inline Ended run_tool(const std::filesystem::path& folder, const std::string& arguments, const std::string& before = "") {
  const std::string command =
      "cd '" + folder.string() + "' && " + before + " '" DUO_TOOL "' " + arguments + " >stdout.txt 2>stderr.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), bytes_of(folder / "stdout.txt"),
          bytes_of(folder / "stderr.txt")};
}

}  // namespace duo::test
