// Pictures in memory: View (pixels somebody else owns) and Image (pixels this object owns).
// Pixel order is always (y, x), sizes are always (width, height), strides count elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace [[gnu::visibility("default")]] duo {

struct Size {
  int width = 0;
  int height = 0;
  friend bool operator==(const Size&, const Size&) = default;
  bool empty() const { return width <= 0 || height <= 0; }
};

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// A rectangle of pixels that it does not own; free to copy.
///
/// Units   `stride` in elements of T, >= width
template <class T>
class View {
 public:
  View() = default;
  View(T* data, Size size, std::ptrdiff_t stride) : data_(data), size_(size), stride_(stride) {}
  /// A view of mutable pixels is also a view of const ones.
  template <class U>
    requires(std::is_same_v<T, const U>)
  View(const View<U>& other)  // NOLINT: implicit like T* -> const T*
      : data_(other.data()), size_(other.size()), stride_(other.stride()) {}

  T* data() const { return data_; }
  T* row(int y) const { return data_ + y * stride_; }
  T& at(int y, int x) const { return row(y)[x]; }
  Size size() const { return size_; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  std::ptrdiff_t stride() const { return stride_; }
  bool empty() const { return size_.empty(); }

  /// The part that starts at (y, x); must lie inside.
  View crop(int y, int x, Size size) const { return View(row(y) + x, size, stride_); }

 private:
  T* data_ = nullptr;
  Size size_;
  std::ptrdiff_t stride_ = 0;
};

/// A rectangle of pixels that it owns; move-only, clone() to copy.
///
/// Rows start on 64-byte boundaries and are padded to a multiple of 64 bytes; 64 more bytes after the last
/// row may be read, so that vector code can load past the end of any row. New pixels are zero.
template <class T>
class Image {
  static_assert(std::is_trivially_copyable_v<T>);
  static constexpr std::size_t kAlign = 64;
  struct Free {
    void operator()(T* p) const { ::operator delete[](static_cast<void*>(p), std::align_val_t{kAlign}); }
  };

 public:
  Image() = default;
  explicit Image(Size size) : size_(size) {
    if (size.empty()) {
      size_ = {};
      return;
    }
    // A stride in whole elements and whole 64-byte blocks (Rgb8 has 3 bytes: 192 is the block there).
    constexpr std::size_t kBlock = kAlign % sizeof(T) == 0 ? kAlign / sizeof(T) : kAlign;
    stride_ = static_cast<std::ptrdiff_t>((static_cast<std::size_t>(size.width) + kBlock - 1) / kBlock * kBlock);
    const std::size_t bytes = static_cast<std::size_t>(stride_) * size.height * sizeof(T) + kAlign;
    void* p = ::operator new[](bytes, std::align_val_t{kAlign});
    std::memset(p, 0, bytes);
    data_.reset(static_cast<T*>(p));
  }
  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(Image&& other) noexcept {
    Image(std::move(other)).swap(*this);
    return *this;
  }

  Image clone() const {
    Image copy(size_);
    if (!size_.empty())
      std::memcpy(copy.data_.get(), data_.get(), static_cast<std::size_t>(stride_) * size_.height * sizeof(T));
    return copy;
  }

  T* row(int y) { return data_.get() + y * stride_; }
  const T* row(int y) const { return data_.get() + y * stride_; }
  T& at(int y, int x) { return row(y)[x]; }
  const T& at(int y, int x) const { return row(y)[x]; }
  Size size() const { return size_; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  std::ptrdiff_t stride() const { return stride_; }
  bool empty() const { return size_.empty(); }

  View<T> view() { return {data_.get(), size_, stride_}; }
  View<const T> view() const { return {data_.get(), size_, stride_}; }
  operator View<T>() { return view(); }              // NOLINT: an image is used where a view is asked for
  operator View<const T>() const { return view(); }  // NOLINT
  operator View<const T>() { return std::as_const(*this).view(); }  // NOLINT

  void swap(Image& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(stride_, other.stride_);
  }

 private:
  std::unique_ptr<T[], Free> data_;
  Size size_;
  std::ptrdiff_t stride_ = 0;
};

}  // namespace duo
