// Any bytes as a pipeline cache: none but what was written comes back.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/check.h"
#include "vulkan/pipeline_cache.h"

int fuzz_kept(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = [] {
    std::string name = (std::filesystem::temp_directory_path() / "duoptic_fuzz_XXXXXX").string();
    DUO_CHECK(mkdtemp(name.data()) != nullptr);
    std::atexit([] { std::filesystem::remove_all(folder); });
    return name;
  }();
  const std::filesystem::path file = folder / "kept";
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  std::ofstream(file, std::ios::binary) << bytes;
  const std::string kept = duo::vk::read_pipelines(file);
  DUO_CHECK(kept.empty() || bytes.ends_with(kept));
  return 0;
}
