// Runs others' programs for bags.
#pragma once

#include "bag/bags.hpp"
#include "support/peer_test.hpp"

namespace palpate::bag {

class McapPeer : public test::PeerTest {
 protected:
  McapPeer() : PeerTest("@mcap/core") {}
};

}  // namespace palpate::bag
