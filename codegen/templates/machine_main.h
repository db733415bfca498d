/* What the runner of a target asks of the machine: files of the host by semihosting, and measured calls. */
#ifndef MACHINE_MAIN_H
#define MACHINE_MAIN_H

#include <stdint.h>

typedef int (*entry_t)(void *first, void *second, void *third, void *fourth);

typedef struct
{
    int32_t status;
    uint32_t ticks; /* of a counter that follows instructions, not time */
    uint32_t stack; /* bytes that the call overwrote below the caller's stack pointer */
} measured_t;

/* Call a function, count its instructions and see how much of a painted stack it used. */
measured_t measured_call(entry_t function, void *first, void *second, void *third, void *fourth);

/* The shortest function there is: one instruction, the return. */
int shortest(void *first, void *second, void *third, void *fourth);

/* Read exactly so many bytes of the calls; 0 at the end of the file. */
int read_calls(void *to, uint32_t size);

void write_answers(const void *from, uint32_t size);

/* What the runner of a block does; called when the machine is up. */
void run_calls(void);

#endif
