// Objects that are made once and lent over and over.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace duo {

/// Lends objects as shared pointers; an object whose last pointer is gone is lent again, as it then is. Objects outlive the
/// pool while someone has them. Lending allocates nothing while an object is free: the pointers' reference counts lie in the
/// pool, too.
///
/// Threads  any
template <class T>
class ObjectPool {
 public:
  ObjectPool() = default;
  /// `make` is called `count` times now, and once more each time that all objects are lent.
  ObjectPool(std::size_t count, std::function<T()> make) : shelf_(std::make_shared<Shelf>()) {
    shelf_->make = std::move(make);
    for (std::size_t i = 0; i < count; ++i) shelf_->add();
  }

  /// An object that nobody else has.
  std::shared_ptr<T> lend() {
    Place* place = nullptr;
    {
      const std::lock_guard lock(shelf_->mutex);
      if (shelf_->free.empty()) shelf_->add();
      place = shelf_->free.back();
      shelf_->free.pop_back();
    }
    return std::shared_ptr<T>(
        &place->object, [](T*) {}, CountAllocator<T>{shelf_, place});
  }

  /// Objects there are, lent or not.
  std::size_t size() const {
    const std::lock_guard lock(shelf_->mutex);
    return shelf_->places.size();
  }

 private:
  struct Place {
    explicit Place(T made) : object(std::move(made)) {}
    T object;
    alignas(std::max_align_t) std::array<std::byte, 96> count;  // the shared pointers' reference count
  };
  struct Shelf {
    void add() {
      free.reserve(places.size() + 1);
      free.push_back(&places.emplace_back(make()));
    }
    std::mutex mutex;
    std::function<T()> make;
    std::deque<Place> places;  // keeps their addresses
    std::vector<Place*> free;
  };

  /// Puts a reference count into its place. The place is free once the count is gone, which is after the last pointer.
  template <class U>
  struct CountAllocator {
    using value_type = U;
    CountAllocator(std::shared_ptr<Shelf> of, Place* at) : shelf(std::move(of)), place(at) {}
    template <class V>
    CountAllocator(const CountAllocator<V>& other) : shelf(other.shelf), place(other.place) {}  // NOLINT: allocators convert
    U* allocate(std::size_t) {
      static_assert(sizeof(U) <= sizeof(Place::count) && alignof(U) <= alignof(std::max_align_t));
      return reinterpret_cast<U*>(place->count.data());
    }
    void deallocate(U*, std::size_t) {
      const std::lock_guard lock(shelf->mutex);
      shelf->free.push_back(place);  // there is room: add() saw to it
    }
    template <class V>
    bool operator==(const CountAllocator<V>& other) const {
      return place == other.place;
    }
    std::shared_ptr<Shelf> shelf;
    Place* place;
  };

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace duo
