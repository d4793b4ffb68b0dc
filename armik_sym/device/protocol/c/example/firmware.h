/* The sending side: reads the sensors at a fixed rate and sends them. Needs the functions of board.h. */
#ifndef FIRMWARE_H
#define FIRMWARE_H

/* Call once, when the clock and the serial port run: sends what the device says about itself. */
void firmware_start(void);

/* Call for ever, as often as possible: sends a sample when it is due, and the info once a second. */
void firmware_step(void);

#endif
