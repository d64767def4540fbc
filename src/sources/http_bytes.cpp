#include "sources/http_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

namespace duo {

std::string HttpBytes::open(const std::string& url) {
  static const CURLcode ready = curl_global_init(CURL_GLOBAL_DEFAULT);
  close();
  transfers_.reset(curl_multi_init());
  transfer_.reset(curl_easy_init());
  if (ready != CURLE_OK || !transfers_ || !transfer_) return "out of memory";
  CURL* t = transfer_.get();
  curl_easy_setopt(t, CURLOPT_URL, url.c_str());
  curl_easy_setopt(t, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(t, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(t, CURLOPT_HTTPAUTH, CURLAUTH_BASIC | CURLAUTH_DIGEST);
  // Cameras certify themselves.
  curl_easy_setopt(t, CURLOPT_SSL_VERIFYPEER, 0L);
  curl_easy_setopt(t, CURLOPT_SSL_VERIFYHOST, 0L);
  curl_easy_setopt(t, CURLOPT_HTTP_VERSION, CURL_HTTP_VERSION_1_1);
  curl_easy_setopt(t, CURLOPT_FAILONERROR, 1L);
  curl_easy_setopt(t, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(t, CURLOPT_QUICK_EXIT, 1L);  // without waiting for a name to be found
  curl_easy_setopt(t, CURLOPT_WRITEFUNCTION, take);
  curl_easy_setopt(t, CURLOPT_WRITEDATA, this);
  if (curl_multi_add_handle(transfers_.get(), t) != CURLM_OK) return "out of memory";
  const bool any = wait();
  long code = 0;
  const char* elsewhere = nullptr;
  curl_easy_getinfo(t, CURLINFO_RESPONSE_CODE, &code);
  curl_easy_getinfo(t, CURLINFO_REDIRECT_URL, &elsewhere);
  if (code >= 300 && code < 400)
    return fmt::format("it sends us on to {}; name that if you trust it", elsewhere != nullptr ? elsewhere : "nowhere");
  if (any) return {};
  return outcome_ == CURLE_OK ? "it gives nothing" : curl_easy_strerror(outcome_);
}

/// Until there are bytes; false when none come any more.
bool HttpBytes::wait() {
  constexpr int kStep_ms = 20;
  while (read_ == bytes_.size()) {
    if (ended_ || is_over_()) return false;
    bytes_.clear();
    read_ = 0;
    if (std::exchange(paused_, false)) curl_easy_pause(transfer_.get(), CURLPAUSE_CONT);
    int running = 0, left = 0;
    if (curl_multi_perform(transfers_.get(), &running) != CURLM_OK) return false;
    while (const CURLMsg* message = curl_multi_info_read(transfers_.get(), &left))
      if (message->msg == CURLMSG_DONE) outcome_ = message->data.result;
    ended_ = running == 0;
    if (bytes_.empty() && !ended_) curl_multi_poll(transfers_.get(), nullptr, 0, kStep_ms, nullptr);
  }
  return true;
}

std::size_t HttpBytes::take(char* bytes, std::size_t, std::size_t size, void* self) {
  auto& http = *static_cast<HttpBytes*>(self);
  constexpr std::size_t kMostWaiting = 1 << 20;
  if (http.bytes_.size() >= kMostWaiting) return http.paused_ = true, CURL_WRITEFUNC_PAUSE;
  try {
    http.bytes_.append(bytes, size);
    return size;
  } catch (const std::bad_alloc&) {
    return 0;  // ends the transfer
  }
}

int HttpBytes::read(std::uint8_t* into, int size) {
  if (!wait()) return 0;
  const std::size_t n = std::min(bytes_.size() - read_, static_cast<std::size_t>(size));
  bytes_.copy(reinterpret_cast<char*>(into), n, read_);
  read_ += n;
  return static_cast<int>(n);
}

std::string HttpBytes::kind() const {
  const char* kind = nullptr;
  curl_easy_getinfo(transfer_.get(), CURLINFO_CONTENT_TYPE, &kind);
  return kind != nullptr ? kind : "";
}

void HttpBytes::close() {
  if (transfer_ && transfers_) curl_multi_remove_handle(transfers_.get(), transfer_.get());
  transfer_.reset();
  transfers_.reset();
  bytes_.clear();
  read_ = 0;
  paused_ = ended_ = false;
  outcome_ = CURLE_OK;
}

}  // namespace duo
