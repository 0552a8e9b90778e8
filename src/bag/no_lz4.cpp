// In place of lz4.cpp in a tab of a browser: what palpate records is packed by zstd.
#include "bag/lz4.hpp"

namespace palpate::bag {

bool unpack_lz4(View /*from*/, Bytes& /*to*/) {
  throw Error("it is packed by lz4, which the program palpate unpacks, and a tab does not");
}

}  // namespace palpate::bag
