#include "vulkan/pipeline_cache.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>

#include "core/cache_file.h"
#include "core/file.h"

namespace duo::vk {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr char kKind[] = "duoptic pipelines 1\n";
constexpr std::size_t kKindBytes = sizeof(kKind) - 1, kHeadBytes = kKindBytes + sizeof(std::uint64_t);

/// FNV-1a, 64 bits (Fowler, Noll, Vo).
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

std::string head_of(std::string_view data) {
  const std::uint64_t sum = checksum(data);
  std::string head(kHeadBytes, '\0');
  std::memcpy(head.data(), kKind, kKindBytes);
  std::memcpy(head.data() + kKindBytes, &sum, sizeof(sum));
  return head;
}

/// A driver trusts what it wrote itself: nobody else may have been able to write it.
bool is_ours(const std::filesystem::path& path) {
  struct stat there {};
  return ::lstat(path.c_str(), &there) == 0 && there.st_uid == ::geteuid() && (there.st_mode & S_IWOTH) == 0;
}

}  // namespace

std::filesystem::path pipeline_file(const std::string& device_id) { return cache_file("pipelines-" + device_id); }

std::string read_pipelines(const std::filesystem::path& file) {
  if (file.empty()) return {};
  if (!is_ours(file.parent_path()) || !is_ours(file)) return {};
  const auto bytes = read_file(file, kMostBytes, "pipeline cache");
  if (!bytes || bytes->size() < kHeadBytes) return {};
  const std::string_view data = std::string_view(*bytes).substr(kHeadBytes);
  return bytes->compare(0, kHeadBytes, head_of(data)) == 0 ? std::string(data) : std::string();
}

void write_pipelines(const std::filesystem::path& file, const std::string& data) {
  if (data.empty() || data.size() > kMostBytes - kHeadBytes) return;
  write_cache_file(file, head_of(data) + data);
}

}  // namespace duo::vk
