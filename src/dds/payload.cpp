// Implements a DDS type whose values are encoded bytes, as Cyclone wants it.
#include "dds/payload.hpp"

#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace palpate::dds {
namespace {

struct Payload : ddsi_serdata {
  std::vector<std::uint8_t> bytes;
  std::uint64_t number = 0;
};

// Values are sent in multiples of four bytes.
constexpr std::size_t kUnit = 4;

const Payload& payload(const ddsi_serdata* value) {
  return *static_cast<const Payload*>(value);
}

Payload* make(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto* made = new Payload;
  ddsi_serdata_init(made, type, kind);
  made->bytes.resize(size);
  return made;
}

void pad(Payload& made) {
  made.bytes.resize((made.bytes.size() + kUnit - 1) / kUnit * kUnit);
}

// The number that its writer gave a message: in the head of the submessage (RTPS 2.3, 9.4.5.3),
// where Cyclone has brought it into the byte order of this machine. 0: unknown.
std::uint64_t number_in(const nn_rdata* fragment) {
  constexpr std::size_t kOffset = 16;
  if (fragment == nullptr || fragment->submsg_zoff == 0) return 0;
  std::array<std::uint32_t, 2> number{};  // high, low
  const unsigned char* from = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_SUBMSG_OFF(fragment));
  std::memcpy(number.data(), from + kOffset, sizeof number);
  return (std::uint64_t{number[0]} << 32) | number[1];
}

// Fragments follow one another, and may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  Payload* made = make(type, kind, size);
  made->number = number_in(fragment);
  std::size_t at = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end <= at || fragment->min > at) continue;
    const unsigned char* from = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(made->bytes.data() + at, from + (at - fragment->min), end - at);
    at = end;
  }
  pad(*made);
  return made;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t pieces, const ddsrt_iovec_t* piece, std::size_t size) {
  Payload* made = make(type, kind, size);
  std::size_t at = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < pieces && at < size; ++i) {
    const std::size_t take = std::min<std::size_t>(piece[i].iov_len, size - at);
    std::memcpy(made->bytes.data() + at, piece[i].iov_base, take);
    at += take;
  }
  pad(*made);
  return made;
}

ddsi_serdata* referenced(const ddsi_serdata* value, std::size_t at, std::size_t size,
                         ddsrt_iovec_t* piece) {
  piece->iov_base = const_cast<std::uint8_t*>(payload(value).bytes.data()) + at;
  piece->iov_len = size;
  return ddsi_serdata_ref(value);
}

// ROS messages have no keys: all values of a topic are one instance.
const ddsi_serdata_ops kValues = {
    .eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; },
    .get_size = [](const ddsi_serdata* value) -> std::uint32_t {
      return static_cast<std::uint32_t>(payload(value).bytes.size());
    },
    .from_ser = from_fragments,
    .from_ser_iov = from_pieces,
    .from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) -> ddsi_serdata* {
      return make(type, SDK_KEY, 0);
    },
    .from_sample = nullptr,  // only encoded bytes are written
    .to_ser = [](const ddsi_serdata* value, std::size_t at, std::size_t size,
                 void* to) { std::memcpy(to, payload(value).bytes.data() + at, size); },
    .to_ser_ref = referenced,
    .to_ser_unref = [](ddsi_serdata* value, const ddsrt_iovec_t*) { ddsi_serdata_unref(value); },
    .to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; },
    .to_untyped = [](const ddsi_serdata* value) -> ddsi_serdata* {
      Payload* made = make(value->type, SDK_KEY, 0);
      made->type = nullptr;
      return made;
    },
    .untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**,
                            void*) { return true; },
    .free = [](ddsi_serdata* value) { delete static_cast<Payload*>(value); },
    .print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, std::size_t) -> std::size_t {
      *text = '\0';
      return 0;
    },
    .get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash,
                      bool) { std::memset(hash, 0, sizeof(*hash)); },
    .get_sample_size = nullptr,
    .from_iox_buffer = nullptr,
};

const ddsi_sertype_ops kTypes = {
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free =
        [](ddsi_sertype* type) {
          ddsi_sertype_fini(type);
          delete type;
        },
    .zero_samples = [](const ddsi_sertype*, void*, std::size_t) {},
    .realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {},
    .free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {},
    .equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; },
    .hash = [](const ddsi_sertype*) -> std::uint32_t { return 0; },
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = [](const ddsi_sertype* type, dds_data_representation_id_t,
                         dds_type_consistency_enforcement_qospolicy_t) -> ddsi_sertype* {
      return const_cast<ddsi_sertype*>(type);
    },
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

}  // namespace

ddsi_sertype* make_type(const std::string& dds_name) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, dds_name.c_str(), &kTypes, &kValues,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* make_payload(const ddsi_sertype* type, std::span<const std::uint8_t> bytes) {
  Payload* made = make(type, SDK_DATA, 0);
  made->bytes.assign(bytes.begin(), bytes.end());
  pad(*made);
  return made;
}

std::uint64_t number_of(const ddsi_serdata* value) {
  return payload(value).number;
}

std::span<const std::uint8_t> bytes_of(const ddsi_serdata* value) {
  return payload(value).bytes;
}

}  // namespace palpate::dds
