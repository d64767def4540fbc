// The container MCAP: messages of named channels with their times, in chunks that an index at the end finds again.
// Source  the MCAP format specification, version 0 (mcap.dev/spec)
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/file.h"

namespace duo {

/// Bytes of records: whole numbers little-endian, texts behind their length.
class McapBytes {
 public:
  template <class T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
  void text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
  }
  void raw(std::string_view value) { bytes_ += value; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Writes such a file. Messages are gathered until end_chunk().
class McapFile {
 public:
  /// `profile`: whose conventions topics and schemas follow, "ros2".
  ///
  /// Errors  those of every written file
  static Result<McapFile> open(const std::filesystem::path& path, std::string_view profile);

  /// A channel of messages of one schema; its number.
  std::uint16_t add_channel(std::string_view topic, std::string_view schema, std::string_view schema_text);
  void add_message(std::uint16_t channel, std::uint64_t t_ns, std::string_view data);
  /// Errors  those of every written file
  Result<void> end_chunk();
  /// Writes the index and gives the file its name.
  ///
  /// Errors  those of every written file
  Result<void> finish();

 private:
  struct Channel {
    std::string schema, channel;  // their records
    std::uint32_t messages = 0;
  };
  explicit McapFile(PartialFile file) : file_(std::move(file)) {}
  Result<void> write(std::string_view bytes);

  PartialFile file_;
  std::uint64_t written_ = 0;
  std::vector<Channel> channels_;                                                           // number 1 is the first
  std::size_t told_ = 0;                                                                    // of channels_, in a chunk
  std::string chunk_;                                                                       // records
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> in_chunk_;  // time and offset by channel
  std::uint64_t chunk_start_ns_ = 0, chunk_end_ns_ = 0, start_ns_ = 0, end_ns_ = 0;
  std::vector<std::string> chunk_indexes_;
};

}  // namespace duo
