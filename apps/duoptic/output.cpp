#include "output.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace duo::app {
namespace fs = std::filesystem;

namespace {

Error cannot_write(const fs::path& path, const std::string& why) {
  return {ErrorCode::kWriteFailed, fmt::format("cannot write to {}: {}", path.string(), why)};
}

}  // namespace

Result<OutputSet> OutputSet::open(const fs::path& folder) {
  OutputSet out;
  out.folder_ = folder;
  std::error_code error;
  fs::path part;
  for (const fs::path& step : folder) {
    part /= step;
    if (step.empty() || fs::is_directory(part, error)) continue;
    if (!fs::create_directory(part, error)) return cannot_write(part, error ? error.message() : "it is not a folder");
    out.made_.push_back(part);
  }
  std::string staging = (folder / ".duoptic-XXXXXX").string();
  if (mkdtemp(staging.data()) == nullptr) return cannot_write(folder, std::strerror(errno));
  out.staging_ = staging;
  return out;
}

OutputSet::OutputSet(OutputSet&& other) noexcept
    : folder_(std::move(other.folder_)),
      staging_(std::exchange(other.staging_, {})),
      made_(std::exchange(other.made_, {})),
      names_(std::move(other.names_)) {}

OutputSet::~OutputSet() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, ignored);  // only when empty
}

fs::path OutputSet::operator/(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

Result<void> OutputSet::publish() {
  std::error_code error;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    fs::rename(staging_ / names_[i], folder_ / names_[i], error);
    if (!error) continue;
    const Error failure = cannot_write(folder_ / names_[i], error.message());
    for (std::size_t done = 0; done < i; ++done) fs::remove(folder_ / names_[done], error);
    return failure;
  }
  made_.clear();
  return {};
}

std::vector<std::string> OutputSet::paths() const {
  std::vector<std::string> out;
  for (const std::string& name : names_) out.push_back((folder_ / name).string());
  return out;
}

}  // namespace duo::app
