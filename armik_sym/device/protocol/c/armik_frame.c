#include "armik_frame.h"

#define PREAMBLE 2
#define SAMPLE_HEAD 12
#define INFO_HEAD 9
#define INFO_CHANNEL 5
#define CRC_SIZE 4
#define AT_PAYLOAD 2 /* on the wire: the delimiter and the first code byte come before */
#define WIDEST_POTENTIOMETER UINT32_C(0x10000)

/* Four bits at a time: 64 bytes of table where the usual one takes 1,024. */
static const uint32_t crc_of_nibble[16] = {
    UINT32_C(0x00000000), UINT32_C(0x1DB71064), UINT32_C(0x3B6E20C8), UINT32_C(0x26D930AC),
    UINT32_C(0x76DC4190), UINT32_C(0x6B6B51F4), UINT32_C(0x4DB26158), UINT32_C(0x5005713C),
    UINT32_C(0xEDB88320), UINT32_C(0xF00F9344), UINT32_C(0xD6D6A3E8), UINT32_C(0xCB61B38C),
    UINT32_C(0x9B64C2B0), UINT32_C(0x86D3D2D4), UINT32_C(0xA00AE278), UINT32_C(0xBDBDF21C)};

uint32_t armik_crc32(const uint8_t *data, size_t size) {
  uint32_t crc = UINT32_C(0xFFFFFFFF);
  for (size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    crc = (crc >> 4) ^ crc_of_nibble[crc & 15u];
    crc = (crc >> 4) ^ crc_of_nibble[crc & 15u];
  }
  return crc ^ UINT32_C(0xFFFFFFFF);
}

static uint8_t *put16(uint8_t *at, uint16_t value) {
  at[0] = (uint8_t)(value & 0xFFu);
  at[1] = (uint8_t)(value >> 8);
  return at + 2;
}

static uint8_t *put32(uint8_t *at, uint32_t value) {
  return put16(put16(at, (uint16_t)(value & 0xFFFFu)), (uint16_t)(value >> 16));
}

static uint16_t get16(const uint8_t *at) { return (uint16_t)(at[0] | ((uint16_t)at[1] << 8)); }

static uint32_t get32(const uint8_t *at) { return get16(at) | ((uint32_t)get16(at + 2) << 16); }

/* In place of memcpy: a compiler without a library has no string.h. */
static void copy(uint8_t *to, const uint8_t *from, size_t size) {
  for (size_t i = 0; i < size; ++i) to[i] = from[i];
}

static uint8_t is_set(uint8_t flags, uint8_t bit) { return (uint8_t)(((unsigned)flags >> bit) & 1u); }

static uint8_t flags_set(uint8_t flags) {
  uint8_t n = 0;
  for (uint8_t bit = 0; bit < 8; ++bit) n = (uint8_t)(n + is_set(flags, bit));
  return n;
}

/* ---- writing ---- */

/* The payload stands at wire + AT_PAYLOAD: append its checksum, take the zeros out, set the delimiters. */
static size_t close_frame(uint8_t *wire, size_t size) {
  const size_t end = AT_PAYLOAD + size + CRC_SIZE;
  size_t code = AT_PAYLOAD - 1;
  put32(wire + AT_PAYLOAD + size, armik_crc32(wire + AT_PAYLOAD, size));
  for (size_t i = AT_PAYLOAD; i < end; ++i) {
    if (wire[i] == 0) {
      wire[code] = (uint8_t)(i - code);
      code = i;
    }
  }
  wire[code] = (uint8_t)(end - code);
  wire[0] = 0;
  wire[end] = 0;
  return end + 1;
}

size_t armik_encode_payload(const uint8_t *payload, size_t size, uint8_t *wire) {
  if (size > ARMIK_LONGEST_PAYLOAD) return 0;
  copy(wire + AT_PAYLOAD, payload, size);
  return close_frame(wire, size);
}

static uint8_t sample_fits(uint8_t channels, uint8_t index) {
  return channels >= 1 && channels <= ARMIK_MOST_CHANNELS && ((unsigned)index >> channels) == 0;
}

size_t armik_encode_sample(const armik_sample *sample, uint8_t *wire) {
  uint8_t *at = wire + AT_PAYLOAD;
  if (!sample_fits(sample->channels, sample->index)) return 0;
  *at++ = ARMIK_VERSION;
  *at++ = ARMIK_KIND_SAMPLE;
  at = put32(at, sample->sequence);
  at = put32(at, sample->time_us);
  *at++ = sample->channels;
  *at++ = sample->index;
  for (uint8_t k = 0; k < sample->channels; ++k) at = put16(at, sample->counts[k]);
  for (uint8_t k = 0; k < sample->channels; ++k)
    if (is_set(sample->index, k)) at = put16(at, sample->index_counts[k]);
  return close_frame(wire, (size_t)(at - wire) - AT_PAYLOAD);
}

static uint8_t channel_fits(uint8_t kind, uint32_t span) {
  if (span < 2) return 0;
  return kind == ARMIK_ENCODER || (kind == ARMIK_POTENTIOMETER && span <= WIDEST_POTENTIOMETER);
}

/* Length of a name of printable ASCII characters; more than the longest if it is none. */
static uint8_t name_length(const char *name) {
  uint8_t length = 0;
  while (length <= ARMIK_LONGEST_NAME && name[length] >= 0x20 && name[length] <= 0x7E) ++length;
  return length <= ARMIK_LONGEST_NAME && name[length] == 0 ? length : ARMIK_LONGEST_NAME + 1;
}

static uint8_t info_fits(const armik_info *info) {
  if (info->rate_hz == 0 || info->channels < 1 || info->channels > ARMIK_MOST_CHANNELS) return 0;
  for (uint8_t k = 0; k < info->channels; ++k)
    if (!channel_fits(info->kind[k], info->span[k])) return 0;
  return name_length(info->firmware) <= ARMIK_LONGEST_NAME;
}

size_t armik_encode_info(const armik_info *info, uint8_t *wire) {
  uint8_t *at = wire + AT_PAYLOAD;
  uint8_t name;
  if (!info_fits(info)) return 0;
  *at++ = ARMIK_VERSION;
  *at++ = ARMIK_KIND_INFO;
  at = put32(at, info->device_id);
  at = put16(at, info->rate_hz);
  *at++ = info->channels;
  for (uint8_t k = 0; k < info->channels; ++k) {
    *at++ = info->kind[k];
    at = put32(at, info->span[k]);
  }
  name = name_length(info->firmware);
  *at++ = name;
  copy(at, (const uint8_t *)info->firmware, name);
  return close_frame(wire, (size_t)(at - wire) - AT_PAYLOAD + name);
}

/* ---- reading ---- */

static uint8_t read_sample(const uint8_t *payload, uint8_t size, armik_sample *sample) {
  const uint8_t *at = payload + SAMPLE_HEAD;
  uint8_t channels, index;
  if (size < SAMPLE_HEAD) return 0;
  channels = payload[10];
  index = payload[11];
  if (!sample_fits(channels, index) || size != SAMPLE_HEAD + 2 * (channels + flags_set(index))) return 0;
  *sample = (armik_sample){0};
  sample->sequence = get32(payload + 2);
  sample->time_us = get32(payload + 6);
  sample->channels = channels;
  sample->index = index;
  for (uint8_t k = 0; k < channels; ++k, at += 2) sample->counts[k] = get16(at);
  for (uint8_t k = 0; k < channels; ++k) {
    if (!is_set(index, k)) continue;
    sample->index_counts[k] = get16(at);
    at += 2;
  }
  return 1;
}

static uint8_t read_info(const uint8_t *payload, uint8_t size, armik_info *info) {
  const uint8_t *at = payload + INFO_HEAD;
  uint8_t channels, name;
  if (size < INFO_HEAD) return 0;
  channels = payload[8];
  if (channels > ARMIK_MOST_CHANNELS || size <= INFO_HEAD + INFO_CHANNEL * channels) return 0;
  name = payload[INFO_HEAD + INFO_CHANNEL * channels];
  if (name > ARMIK_LONGEST_NAME || size != INFO_HEAD + INFO_CHANNEL * channels + 1 + name) return 0;
  *info = (armik_info){0};
  info->device_id = get32(payload + 2);
  info->rate_hz = get16(payload + 6);
  info->channels = channels;
  for (uint8_t k = 0; k < channels; ++k, at += INFO_CHANNEL) {
    info->kind[k] = at[0];
    info->span[k] = get32(at + 1);
  }
  copy((uint8_t *)info->firmware, at + 1, name);
  /* A zero inside the name would make it shorter than it says it is. */
  return info_fits(info) && name_length(info->firmware) == name;
}

static armik_event read_other(const uint8_t *payload, uint8_t size, armik_other *other) {
  other->kind = payload[1];
  other->size = (uint8_t)(size - PREAMBLE);
  copy(other->body, payload + PREAMBLE, other->size);
  return ARMIK_OTHER;
}

/* What a payload says; its checksum is right. */
static armik_event read_payload(armik_parser *parser, const uint8_t *payload, uint8_t size, armik_frame *frame) {
  armik_counts *counts = &parser->counts;
  if (size < PREAMBLE) {
    ++counts->malformed;
    return ARMIK_NOTHING;
  }
  parser->latest_version = payload[0];
  if (payload[0] != ARMIK_VERSION) {
    ++counts->unknown_version;
    return ARMIK_NOTHING;
  }
  if (payload[1] == ARMIK_KIND_SAMPLE) {
    if (read_sample(payload, size, &frame->sample)) {
      ++counts->samples;
      return ARMIK_SAMPLE;
    }
  } else if (payload[1] == ARMIK_KIND_INFO) {
    if (read_info(payload, size, &frame->info)) {
      ++counts->infos;
      return ARMIK_INFO;
    }
  } else {
    ++counts->unknown_kind;
    return read_other(payload, size, &frame->other);
  }
  ++counts->malformed;
  return ARMIK_NOTHING;
}

/* Put the zeros back, in place; 0 if the distances do not end where the chunk ends. */
static uint8_t unstuff(uint8_t *chunk, uint8_t length) {
  uint8_t place = 0;
  while (place < length) {
    const uint8_t distance = chunk[place]; /* never 0: the chunk ended at the first zero */
    if (distance > length - place) return 0;
    chunk[place] = 0;
    place = (uint8_t)(place + distance);
  }
  return 1;
}

static void drop(armik_parser *parser) {
  ++parser->counts.damaged;
  parser->counts.bytes_dropped += parser->length;
  parser->length = 0;
}

/* The delimiter came: is what lies in front of it a frame? */
static armik_event end_chunk(armik_parser *parser, armik_frame *frame) {
  const uint8_t *sealed = parser->chunk + 1;
  const uint8_t length = parser->length;
  parser->synchronised = 1;
  if (length == 0) return ARMIK_NOTHING;
  if (length >= CRC_SIZE + 1 && unstuff(parser->chunk, length)) {
    const uint8_t size = (uint8_t)(length - CRC_SIZE - 1);
    if (armik_crc32(sealed, size) == get32(sealed + size)) {
      parser->length = 0;
      return read_payload(parser, sealed, size, frame);
    }
  }
  drop(parser);
  return ARMIK_NOTHING;
}

void armik_parser_start(armik_parser *parser) { *parser = (armik_parser){0}; }

armik_event armik_parser_take(armik_parser *parser, uint8_t byte, armik_frame *frame) {
  ++parser->counts.bytes_read;
  if (byte == 0) return end_chunk(parser, frame);
  if (!parser->synchronised) {
    ++parser->counts.bytes_dropped;
  } else if (parser->length < ARMIK_LONGEST_CHUNK) {
    parser->chunk[parser->length++] = byte;
  } else {
    drop(parser);
    ++parser->counts.bytes_dropped; /* this byte */
    parser->synchronised = 0;
  }
  return ARMIK_NOTHING;
}
