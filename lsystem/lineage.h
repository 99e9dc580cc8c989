// A module's place in the tree as a number that its descendants inherit: what its random draws depend on.
//
// A module's key is a hash of its parent's key and of its slot in the successor that made it: its symbol's name, and how
// many of that name stand before it there. So a key tells the path from the axiom and nothing of the string around it: a
// production that is changed, or given another module, leaves the keys, and so the draws, of all that does not descend from
// what it changed.
#pragma once

#include <cstdint>
#include <string_view>

namespace cambium {

/// The finalizer of splitmix64 (Steele, Lea, Flood 2014): a bijection that passes the usual batteries on a counter.
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Of the `occurrence`th module called `name` in a successor, from 0.
inline std::uint64_t slot_of(std::string_view name, std::uint64_t occurrence) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return mixed(mixed(hash) ^ occurrence);
}

inline std::uint64_t child_key(std::uint64_t parent, std::uint64_t slot) { return mixed(parent ^ slot); }

/// Of a module that stayed although productions could have matched: its next draws are others.
inline std::uint64_t older_key(std::uint64_t key) { return mixed(key + 0x6a09e667f3bcc909ull); }

}  // namespace cambium
