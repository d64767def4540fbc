#include "sinks/mcap/mcap_file.h"

#include <algorithm>

namespace duo {
namespace {

constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
enum McapOp : std::uint8_t {
  kMcapHeader = 1,
  kMcapFooter,
  kMcapSchema,
  kMcapChannel,
  kMcapMessage,
  kMcapChunk,
  kMcapMessageIndex,
  kMcapChunkIndex,
  kMcapStatistics = 0x0B,
  kMcapDataEnd = 0x0F
};

std::string mcap_record(McapOp op, std::string_view content) {
  McapBytes out;
  out.put(static_cast<std::uint8_t>(op));
  out.put(static_cast<std::uint64_t>(content.size()));
  out.raw(content);
  return out.bytes();
}

}  // namespace

Result<McapFile> McapFile::open(const std::filesystem::path& path, std::string_view profile) {
  DUO_TRY_ASSIGN(PartialFile partial, PartialFile::open(path));
  McapFile file(std::move(partial));
  McapBytes header;
  header.text(profile);
  header.text("duoptic");
  DUO_TRY(file.write(kMcapMagic));
  DUO_TRY(file.write(mcap_record(kMcapHeader, header.bytes())));
  return file;
}

Result<void> McapFile::write(std::string_view bytes) {
  written_ += bytes.size();
  return file_.write(bytes);
}

std::uint16_t McapFile::add_channel(std::string_view topic, std::string_view schema, std::string_view schema_text) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  McapBytes of_schema, of_channel;
  of_schema.put(id);
  of_schema.text(schema);
  of_schema.text("ros2msg");
  of_schema.text(schema_text);
  of_channel.put(id);
  of_channel.put(id);
  of_channel.text(topic);
  of_channel.text("cdr");
  of_channel.put(std::uint32_t{0});  // no metadata
  channels_.push_back({mcap_record(kMcapSchema, of_schema.bytes()), mcap_record(kMcapChannel, of_channel.bytes())});
  return id;
}

void McapFile::add_message(std::uint16_t channel, std::uint64_t t_ns, std::string_view data) {
  for (; told_ < channels_.size(); ++told_) chunk_ += channels_[told_].schema + channels_[told_].channel;
  Channel& of = channels_[channel - std::size_t{1}];
  if (in_chunk_.empty()) chunk_start_ns_ = chunk_end_ns_ = t_ns;
  chunk_start_ns_ = std::min(chunk_start_ns_, t_ns);
  chunk_end_ns_ = std::max(chunk_end_ns_, t_ns);
  in_chunk_[channel].emplace_back(t_ns, chunk_.size());
  McapBytes message;
  message.put(channel);
  message.put(of.messages++);
  message.put(t_ns);  // logged
  message.put(t_ns);  // published
  message.raw(data);
  chunk_ += mcap_record(kMcapMessage, message.bytes());
}

Result<void> McapFile::end_chunk() {
  if (in_chunk_.empty()) return {};
  const auto size = static_cast<std::uint64_t>(chunk_.size());
  McapBytes chunk;
  chunk.put(chunk_start_ns_);
  chunk.put(chunk_end_ns_);
  chunk.put(size);
  chunk.put(std::uint32_t{0});  // no checksum
  chunk.text("");               // not compressed
  chunk.put(size);
  chunk.raw(chunk_);
  const std::uint64_t chunk_at = written_;
  DUO_TRY(write(mcap_record(kMcapChunk, chunk.bytes())));
  const std::uint64_t indexes_at = written_;
  McapBytes offsets;
  for (const auto& [channel, messages] : in_chunk_) {
    McapBytes index;
    index.put(channel);
    index.put(static_cast<std::uint32_t>(messages.size() * 16));
    for (const auto& [t_ns, offset] : messages) index.put(t_ns), index.put(offset);
    offsets.put(channel);
    offsets.put(written_);
    DUO_TRY(write(mcap_record(kMcapMessageIndex, index.bytes())));
  }
  McapBytes index;
  index.put(chunk_start_ns_);
  index.put(chunk_end_ns_);
  index.put(chunk_at);
  index.put(indexes_at - chunk_at);
  index.text(offsets.bytes());
  index.put(written_ - indexes_at);
  index.text("");
  index.put(size);
  index.put(size);
  if (chunk_indexes_.empty()) start_ns_ = chunk_start_ns_;
  start_ns_ = std::min(start_ns_, chunk_start_ns_);
  end_ns_ = std::max(end_ns_, chunk_end_ns_);
  chunk_indexes_.push_back(mcap_record(kMcapChunkIndex, index.bytes()));
  chunk_.clear();
  in_chunk_.clear();
  return {};
}

Result<void> McapFile::finish() {
  DUO_TRY(end_chunk());
  McapBytes no_checksum;
  no_checksum.put(std::uint32_t{0});
  DUO_TRY(write(mcap_record(kMcapDataEnd, no_checksum.bytes())));
  const std::uint64_t summary_at = written_;
  std::string summary;
  McapBytes counts, statistics, footer;
  std::uint64_t messages = 0;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    summary += channels_[i].schema + channels_[i].channel;
    counts.put(static_cast<std::uint16_t>(i + 1));
    counts.put(std::uint64_t{channels_[i].messages});
    messages += channels_[i].messages;
  }
  for (const std::string& index : chunk_indexes_) summary += index;
  statistics.put(messages);
  statistics.put(static_cast<std::uint16_t>(channels_.size()));  // schemas
  statistics.put(static_cast<std::uint32_t>(channels_.size()));
  statistics.put(std::uint32_t{0});  // attachments
  statistics.put(std::uint32_t{0});  // metadata
  statistics.put(static_cast<std::uint32_t>(chunk_indexes_.size()));
  statistics.put(start_ns_);
  statistics.put(end_ns_);
  statistics.text(counts.bytes());
  summary += mcap_record(kMcapStatistics, statistics.bytes());
  DUO_TRY(write(summary));
  footer.put(summary_at);
  footer.put(std::uint64_t{0});  // no offsets of the summary's parts
  footer.put(std::uint32_t{0});  // no checksum
  DUO_TRY(write(mcap_record(kMcapFooter, footer.bytes())));
  DUO_TRY(write(kMcapMagic));
  return file_.publish();
}

}  // namespace duo
