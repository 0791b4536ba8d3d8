// Malformed OSC packets with the expected error of each, shared by the tests and the fuzz corpus.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "osc/osc_test_tools.h"

namespace limber::osc::test {

struct BadPacket {
  const char* description;
  std::string bytes;
};

inline std::string from_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i++) {
    if (hex[i] == ' ') continue;
    bytes += static_cast<char>(digit(hex[i]) * 16 + digit(hex[i + 1]));
    i++;
  }
  return bytes;
}

inline std::string nested(int depth) {
  std::string inner = numbered(1);
  for (int i = 0; i < depth; i++) inner = bundle(1, {inner});
  return inner;
}

inline std::vector<BadPacket> bad_packets() {
  std::vector<BadPacket> list = {
      {"nothing", ""},
      {"one byte", "/"},
      {"five bytes", from_hex("2f61626300")},
      {"address does not end", from_hex("2f616263")},
      {"address without slash", from_hex("61620000 2c000000")},
      {"address with a control character", from_hex("2f610700 2c000000")},
      {"address beyond ASCII", from_hex("2fc3a400 2c000000")},
      {"padding of the address not zero", from_hex("2f610062 2c000000")},
      {"data without tags", from_hex("2f610000 3f800000")},
      {"tags do not end", from_hex("2f610000 2c696969")},
      {"argument missing", from_hex("2f610000 2c690000")},
      {"second argument missing", from_hex("2f610000 2c696600 00000001")},
      {"half a double", from_hex("2f610000 2c640000 3ff00000")},
      {"unknown tag", from_hex("2f610000 2c780000 00000000")},
      {"string does not end", from_hex("2f610000 2c730000 61626364")},
      {"string missing", from_hex("2f610000 2c730000")},
      {"padding of a string not zero", from_hex("2f610000 2c730000 61006263")},
      {"blob without size", from_hex("2f610000 2c620000")},
      {"blob larger than its message", from_hex("2f610000 2c620000 00001000")},
      {"blob with a size that wraps when rounded", from_hex("2f610000 2c626900 fffffffd 00000007")},
      {"blob of four that lacks them", from_hex("2f610000 2c620000 00000004")},
      {"blob, then blob", from_hex("2f610000 2c626200 7fffff00")},
      {"blob, then string", from_hex("2f610000 2c627300 00000100 78000000")},
      {"blob of negative size", from_hex("2f610000 2c620000 80000000 00000000")},
      {"array closes first", from_hex("2f610000 2c5d5b69 00000000 00000007")},
      {"array left open", from_hex("2f610000 2c5b6900 00000007")},
      {"array closed twice", from_hex("2f610000 2c5b695d 5d000000 00000007")},
      {"bundle's name cut off", from_hex("2362756e646c6500")},
      {"bundle's tag cut off", from_hex("2362756e646c6500 00000000")},
      {"another name than bundle", from_hex("2362756e646c6501 0000000000000001")},
      {"element's size cut off to nothing", from_hex("2362756e646c6500 0000000000000001 00000008")},
      {"element larger than the bundle", from_hex("2362756e646c6500 0000000000000001 00000100 2f610000")},
      {"element of negative size", from_hex("2362756e646c6500 0000000000000001 fffffffc")},
      {"element of no size", from_hex("2362756e646c6500 0000000000000001 00000000")},
      {"element of odd size", from_hex("2362756e646c6500 0000000000000001 00000003 2f610000")},
      {"element that is neither", from_hex("2362756e646c6500 0000000000000001 00000004 61000000")},
      {"a good element, then a bad one", bundle(1, {numbered(1), from_hex("2f610000 2c690000")})},
      {"nine bundles in each other", nested(9)},
      {"more than 4096 arguments", Bytes().text("/a").text("," + std::string(4097, 'T')).str()},
      {"string of 1028 bytes", Bytes().text("/a").text(",s").text(std::string(1028, 'x')).str()},
      {"address of 1028 bytes", Bytes().text("/" + std::string(1027, 'x')).text(",").str()},
  };
  const std::string many = Bytes().text("/a").text("," + std::string(4096, 'T')).str();
  list.push_back({"more than 16384 arguments in all", bundle(1, {many, many, many, many, numbered(1)})});
  list.push_back({"65508 bytes", numbered(1) + std::string(65508 - 12, '\0')});
  return list;
}

}  // namespace limber::osc::test
