/* Frames between a device of joint sensors and a host, protocol version 1: encoder and parser.
 *
 * C99, no heap, no recursion, no floating point, no assumption on the size of int. The protocol is described
 * in docs/device_protocol.md; the same in Python is armik_sym.device.protocol. MIT licence. */
#ifndef ARMIK_FRAME_H
#define ARMIK_FRAME_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ARMIK_VERSION 1
#define ARMIK_KIND_INFO 0
#define ARMIK_KIND_SAMPLE 1
#define ARMIK_POTENTIOMETER 0
#define ARMIK_ENCODER 1

#define ARMIK_MOST_CHANNELS 7
#define ARMIK_LONGEST_NAME 16
#define ARMIK_LONGEST_PAYLOAD 64
#define ARMIK_LONGEST_CHUNK (ARMIK_LONGEST_PAYLOAD + 4 + 1) /* CRC-32, and one byte of COBS */
#define ARMIK_LONGEST_WIRE (ARMIK_LONGEST_CHUNK + 2)        /* a delimiter before and one after */

/* One reading of all sensors. */
typedef struct {
  uint32_t sequence; /* from 0, one higher each time, wraps; a sample that could not be sent keeps its number */
  uint32_t time_us;  /* clock of the device when the sensors were read, wraps */
  uint8_t channels;  /* 1 to 7 */
  uint8_t index;     /* bit k: the index pulse of channel k came since the sample before */
  uint16_t counts[ARMIK_MOST_CHANNELS];
  uint16_t index_counts[ARMIK_MOST_CHANNELS]; /* per channel: the register at its index pulse; 0 without */
} armik_sample;

/* What a device says about itself, at start-up and once a second. */
typedef struct {
  uint32_t device_id;
  uint16_t rate_hz; /* at least 1 */
  uint8_t channels; /* 1 to 7 */
  uint8_t kind[ARMIK_MOST_CHANNELS];
  uint32_t span[ARMIK_MOST_CHANNELS]; /* counts of full scale, or per turn: at least 2 */
  char firmware[ARMIK_LONGEST_NAME + 1];
} armik_info;

/* A frame of this version whose kind is neither. */
typedef struct {
  uint8_t kind;
  uint8_t size;
  uint8_t body[ARMIK_LONGEST_PAYLOAD - 2];
} armik_other;

typedef union {
  armik_sample sample;
  armik_info info;
  armik_other other;
} armik_frame;

typedef enum { ARMIK_NOTHING, ARMIK_SAMPLE, ARMIK_INFO, ARMIK_OTHER } armik_event;

/* What a parser has seen; a chunk is what lies between two delimiters, if not empty. All wrap. */
typedef struct {
  uint32_t samples;
  uint32_t infos;
  uint32_t damaged;         /* chunks: too long, wrongly stuffed, wrong checksum */
  uint32_t malformed;       /* right checksum, but the content contradicts itself */
  uint32_t unknown_version; /* right checksum, another version */
  uint32_t unknown_kind;    /* right checksum and version, handed out as ARMIK_OTHER */
  uint32_t bytes_read;
  uint32_t bytes_dropped; /* of damaged chunks, and in front of the first delimiter */
} armik_counts;

typedef struct {
  armik_counts counts;
  uint8_t latest_version; /* of the latest frame with a right checksum, 0 before it */
  uint8_t synchronised;   /* a delimiter was seen, and not too much since */
  uint8_t length;
  uint8_t chunk[ARMIK_LONGEST_CHUNK];
} armik_parser;

/* CRC-32/ISO-HDLC, as in zlib. */
uint32_t armik_crc32(const uint8_t *data, size_t size);

/* Write a frame, delimiters included, and return its bytes; 0 if a value does not fit a frame.
 * `wire` has room for ARMIK_LONGEST_WIRE bytes. */
size_t armik_encode_sample(const armik_sample *sample, uint8_t *wire);
size_t armik_encode_info(const armik_info *info, uint8_t *wire);
size_t armik_encode_payload(const uint8_t *payload, size_t size, uint8_t *wire);

/* Start with all counts at 0; again after the line was closed. */
void armik_parser_start(armik_parser *parser);

/* Take one byte. Unless the answer is ARMIK_NOTHING, `frame` holds the frame this byte completed. */
armik_event armik_parser_take(armik_parser *parser, uint8_t byte, armik_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
