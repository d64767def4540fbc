// What a web address sends, through libcurl: it connects to the host that was named, and to no other that this one names.
#pragma once

#include <curl/curl.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace duo {

/// The body of one answer. Who sends us on to another address is refused.
class HttpBytes {
 public:
  /// `is_over` is asked while nothing comes.
  explicit HttpBytes(std::function<bool()> is_over) : is_over_(std::move(is_over)) {}
  HttpBytes(const HttpBytes&) = delete;
  HttpBytes& operator=(const HttpBytes&) = delete;
  ~HttpBytes() { close(); }

  /// Waits for the first byte.
  ///
  /// Returns  "" or why none comes
  std::string open(const std::string& url);
  /// Fills `into` with what is there, waiting for one byte at least.
  ///
  /// Returns  how many; 0 at the end, or when it is over
  int read(std::uint8_t* into, int size);
  /// "image/jpeg" and the like, as the server calls it.
  std::string kind() const;

 private:
  static std::size_t take(char* bytes, std::size_t, std::size_t size, void* self);
  bool wait();
  void close();

  struct FreeTransfer {
    void operator()(CURL* p) const { curl_easy_cleanup(p); }
  };
  struct FreeTransfers {
    void operator()(CURLM* p) const { curl_multi_cleanup(p); }
  };
  std::function<bool()> is_over_;
  std::unique_ptr<CURLM, FreeTransfers> transfers_;
  std::unique_ptr<CURL, FreeTransfer> transfer_;
  std::string bytes_;     // come, not read
  std::size_t read_ = 0;  // of them
  bool paused_ = false, ended_ = false;
  CURLcode outcome_ = CURLE_OK;
};

}  // namespace duo
