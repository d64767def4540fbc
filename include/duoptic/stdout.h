// Standard output as the name of a file.
#pragma once

#include <filesystem>

namespace [[gnu::visibility("default")]] duo {

/// True for "-" and "/dev/stdout". Whatever writes one file takes such a path: its bytes come out together when the file is
/// whole, or none of them; JSON lines come out line by line.
bool is_stdout(const std::filesystem::path& path);

}  // namespace duo
