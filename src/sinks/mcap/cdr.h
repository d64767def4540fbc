// Messages of ROS 2 as bytes.
// Source  OMG, "DDS Interoperability Wire Protocol (DDSI-RTPS)", 2.5, chapter 10: CDR, little-endian
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace duo {

static_assert(std::endian::native == std::endian::little, "CDR is written as the machine holds its numbers");

/// Fields one after the other, each at a multiple of its own size behind the four bytes of the head.
class Cdr {
 public:
  Cdr() : bytes_("\0\1\0\0", 4) {}  // CDR, little-endian

  template <class T>
  Cdr& put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.resize(kHead + (bytes_.size() - kHead + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  Cdr& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += value;
    bytes_ += '\0';
    return *this;
  }
  /// The number of elements of what follows.
  Cdr& count(std::size_t elements) { return put(static_cast<std::uint32_t>(elements)); }
  Cdr& raw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t kHead = 4;
  std::string bytes_;
};

}  // namespace duo
