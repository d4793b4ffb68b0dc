/* What the firmware needs of a microcontroller: five functions and a list of sensors.
 *
 * To run it on yours, write these for it (board_host.c shows them for a computer) and compile them with
 * firmware.c and armik_frame.c. Then call firmware_start() once and firmware_step() for ever:
 *
 *   int main(void) { set_up_clock_adc_timers_uart(); firmware_start(); for (;;) firmware_step(); }
 *   void setup() { Serial.begin(500000); firmware_start(); }    void loop() { firmware_step(); }    (Arduino)
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

#include "armik_frame.h"

/* The sensors in the order of the joints, the rate, an id no other device has, a name. */
extern const armik_info board_info;

/* Microseconds of a clock that runs through all 32 bits and starts over. */
uint32_t board_micros(void);

/* The potentiometer of this channel: 0 to span - 1. */
uint16_t board_adc(uint8_t channel);

/* The register of the quadrature counter of this channel: all 16 bits, overflowing freely. A counter of
 * more bits: its lowest 16. */
uint16_t board_quadrature(uint8_t channel);

/* Whether the index pulse of this channel came since the last call; if so, *latched is the register at the
 * latest pulse. Let the pulse trigger the timer's input capture, or an interrupt that reads the register;
 * take flag and value together, with that interrupt off. */
uint8_t board_index(uint8_t channel, uint16_t *latched);

/* Send one byte; waits while the transmit buffer is full. */
void board_write(uint8_t byte);

#endif
