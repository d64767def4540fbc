#include "core/cache_file.h"

#include <sys/stat.h>

#include <cstdlib>
#include <system_error>

#include "core/file.h"

namespace duo {

std::filesystem::path cache_file(const std::string& name) {
  const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
  std::filesystem::path folder;
  if (cache != nullptr && *cache == '/')
    folder = cache;
  else if (home != nullptr && *home == '/')
    folder = std::filesystem::path(home) / ".cache";
  else
    return {};
  return folder / "duoptic" / name;
}

void write_cache_file(const std::filesystem::path& file, std::string_view bytes) {
  if (file.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path().parent_path(), ignored);
  ::mkdir(file.parent_path().c_str(), 0700);
  static_cast<void>(write_file(file, bytes));
}

}  // namespace duo
