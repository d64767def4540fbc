#include "archive/sha256.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "core/file.h"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

namespace duo {
namespace {

class Sha256 {
 public:
  Sha256() : state_(av_sha_alloc()) {
    if (state_ == nullptr) throw std::bad_alloc();
    av_sha_init(state_.get(), 256);
  }
  void add(std::string_view bytes) {
    av_sha_update(state_.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::string digest() {
    std::array<std::uint8_t, 32> bytes{};
    av_sha_final(state_.get(), bytes.data());
    std::string out;
    for (const std::uint8_t byte : bytes) out += fmt::format("{:02x}", byte);
    return out;
  }

 private:
  struct Free {
    void operator()(AVSHA* state) const { av_free(state); }
  };
  std::unique_ptr<AVSHA, Free> state_;
};

}  // namespace

std::string sha256(std::string_view text) {
  Sha256 sum;
  sum.add(text);
  return sum.digest();
}

Result<std::string> sha256_of(const std::filesystem::path& path, bool sync,
                              const std::function<void(std::int64_t)>& read_so_far) {
  DUO_TRY_ASSIGN(const Descriptor file, open_file(path, std::numeric_limits<std::int64_t>::max(), "file"));
  if (sync && ::fsync(file.get()) != 0) return write_error(path, errno);
  Sha256 sum;
  std::vector<char> block(std::size_t{1} << 20);
  while (true) {
    const ssize_t n = ::read(file.get(), block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      return Error{ErrorCode::kBadInput, fmt::format("cannot read file '{}': {}", path.string(), std::strerror(errno))};
    if (n == 0) return sum.digest();
    sum.add({block.data(), static_cast<std::size_t>(n)});
    if (read_so_far) read_so_far(n);
  }
}

}  // namespace duo
