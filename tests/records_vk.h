// Lists of plain numbers on a device: what kernels read besides pictures, and what they find.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "tests/agree_vk.h"

namespace duo::test {

/// `count` records of type T on a device. What no kernel wrote reads back as 0xA5 in every byte.
template <class T>
class Records {
 public:
  Records(const vk::Device& device, std::size_t count, const std::string& name)
      : count_(count),
        memory_(must(vk::Buffer::make(device, name, std::max(count, std::size_t{1}) * sizeof(T), vk::Memory::kDevice))),
        staging_(must(vk::Buffer::make(device, name + " staging", memory_.bytes(), vk::Memory::kDownload))) {
    std::memset(staging_.mapped().data(), 0xA5, staging_.bytes());
  }
  Records(const vk::Device& device, std::span<const T> records, const std::string& name)
      : Records(device, records.size(), name) {
    if (!records.empty()) std::memcpy(staging_.mapped().data(), records.data(), records.size_bytes());
  }

  std::size_t count() const { return count_; }
  const vk::Buffer& buffer() const { return memory_; }
  /// What the next record_upload() moves.
  std::span<std::byte> bytes() const { return staging_.mapped(); }
  void record_upload(vk::Recorder& recorder) const { recorder.copy(staging_, memory_, memory_.bytes()); }
  void record_download(vk::Recorder& recorder) const { recorder.copy(memory_, staging_, memory_.bytes()); }
  /// What record_download() fetched.
  std::vector<T> read() const {
    std::vector<T> out(count_);
    if (count_ > 0) std::memcpy(static_cast<void*>(out.data()), staging_.mapped().data(), count_ * sizeof(T));
    return out;
  }

 private:
  std::size_t count_;
  vk::Buffer memory_, staging_;
};

}  // namespace duo::test
