// Packets: the byte layouts.
#include "net/lighting/packets.h"

#include <algorithm>

namespace limber::lighting {

namespace {

constexpr std::uint16_t kOpDmx = 0x5000;
constexpr std::uint16_t kArtNetRevision = 14;
constexpr std::uint8_t kTerminated = 0x40;    // bit 6 of the options
constexpr std::size_t kSacnDataHeader = 126;  // bytes before the values, with the start code
constexpr std::size_t kSacnSyncBytes = 49;
constexpr unsigned kEnttecStart = 0x7e;
constexpr unsigned kEnttecEnd = 0xe7;
constexpr unsigned kEnttecSendDmx = 6;  // label
constexpr std::size_t kEnttecLeastValues = 24;

void byte(std::string& out, unsigned value) { out.push_back(static_cast<char>(value & 255U)); }
void big_endian16(std::string& out, unsigned value) {
  byte(out, value >> 8U);
  byte(out, value);
}
void big_endian32(std::string& out, std::uint32_t value) {
  big_endian16(out, value >> 16U);
  big_endian16(out, value & 0xffffU);
}

// Flags and length of a PDU of sACN that begins `from` bytes into a packet of `size` bytes.
void pdu_length(std::string& out, std::size_t from, std::size_t size) {
  big_endian16(out, 0x7000U | static_cast<unsigned>(size - from));
}

// The root layer of sACN, 38 bytes.
void write_root(std::string& out, std::uint32_t vector, const Cid& cid, std::size_t size) {
  out.clear();
  big_endian16(out, 0x0010);  // preamble size
  big_endian16(out, 0);       // postamble size
  out.append("ASC-E1.17\0\0\0", 12);
  pdu_length(out, 16, size);
  big_endian32(out, vector);
  out.append(reinterpret_cast<const char*>(cid.data()), cid.size());
}

}  // namespace

void write_art_dmx(std::uint16_t universe, std::uint8_t sequence, std::span<const std::uint8_t> values,
                   std::string& out) {
  const std::size_t length = std::max<std::size_t>(2, values.size() + values.size() % 2);
  out.assign("Art-Net\0", 8);
  byte(out, kOpDmx);  // little-endian
  byte(out, kOpDmx >> 8U);
  big_endian16(out, kArtNetRevision);
  byte(out, sequence);
  byte(out, 0);  // physical port
  byte(out, universe);
  byte(out, universe >> 8U & 0x7fU);
  big_endian16(out, static_cast<unsigned>(length));
  out.append(reinterpret_cast<const char*>(values.data()), values.size());
  out.append(length - values.size(), '\0');
}

void write_sacn_data(const SacnHeader& header, std::span<const std::uint8_t> values, std::string& out) {
  const std::size_t size = kSacnDataHeader + values.size();
  write_root(out, 0x00000004, header.cid, size);  // VECTOR_ROOT_E131_DATA
  pdu_length(out, 38, size);
  big_endian32(out, 0x00000002);  // VECTOR_E131_DATA_PACKET
  const std::string_view name = header.source_name.substr(0, kSourceNameBytes - 1);
  out.append(name);
  out.append(kSourceNameBytes - name.size(), '\0');
  byte(out, header.priority);
  big_endian16(out, header.sync_universe);
  byte(out, header.sequence);
  byte(out, header.terminated ? kTerminated : 0U);
  big_endian16(out, header.universe);
  pdu_length(out, 115, size);
  byte(out, 0x02);       // VECTOR_DMP_SET_PROPERTY
  byte(out, 0xa1);       // type of addresses and data
  big_endian16(out, 0);  // first property
  big_endian16(out, 1);  // increment
  big_endian16(out, static_cast<unsigned>(values.size() + 1));
  byte(out, 0);  // start code
  out.append(reinterpret_cast<const char*>(values.data()), values.size());
}

void write_sacn_sync(const Cid& cid, std::uint16_t universe, std::uint8_t sequence, std::string& out) {
  write_root(out, 0x00000008, cid, kSacnSyncBytes);  // VECTOR_ROOT_E131_EXTENDED
  pdu_length(out, 38, kSacnSyncBytes);
  big_endian32(out, 0x00000001);  // VECTOR_E131_EXTENDED_SYNCHRONIZATION
  byte(out, sequence);
  big_endian16(out, universe);
  big_endian16(out, 0);  // reserved
}

void write_enttec(std::span<const std::uint8_t> values, std::string& out) {
  const std::size_t count = std::max(kEnttecLeastValues, values.size());
  const std::size_t length = count + 1;  // with the start code
  out.clear();
  byte(out, kEnttecStart);
  byte(out, kEnttecSendDmx);
  byte(out, static_cast<unsigned>(length));
  byte(out, static_cast<unsigned>(length >> 8U));
  byte(out, 0);  // start code
  out.append(reinterpret_cast<const char*>(values.data()), values.size());
  out.append(count - values.size(), '\0');
  byte(out, kEnttecEnd);
}

}  // namespace limber::lighting
