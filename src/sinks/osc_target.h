// Where OSC messages go: one program, named by its user, by UDP.
#pragma once

#include <lo/lo.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "duoptic/result.h"

namespace duo {

struct FreeOsc {
  void operator()(lo_bundle bundle) const { lo_bundle_free_recursive(bundle); }
};
/// Messages that arrive together; owns those added to it.
using OscBundle = std::unique_ptr<std::remove_pointer_t<lo_bundle>, FreeOsc>;

inline OscBundle new_bundle() { return OscBundle(lo_bundle_new(LO_TT_IMMEDIATE)); }

/// A connected UDP socket that never waits. liblo makes the bytes; it would look the host up, and could block, in every send.
class OscTarget {
 public:
  /// Errors  not host:port, no such host
  static Result<OscTarget> open(const std::string& target);
  OscTarget(OscTarget&& other) noexcept;
  OscTarget& operator=(OscTarget&&) = delete;
  ~OscTarget();

  /// Drops the bundle when the network does not take it at once. That nobody listens is no error: who does may come later.
  void send(const OscBundle& bundle);
  std::int64_t dropped() const { return dropped_; }

 private:
  explicit OscTarget(int fd) : fd_(fd) {}
  int fd_;
  std::int64_t dropped_ = 0;
  std::vector<char> bytes_;
};

}  // namespace duo
