/* Reads a state, speeds and torques of each point from standard input and writes its answer, all as doubles. */
#include <stdio.h>
#include HEADER

int main(void)
{
    double in[1 + N_SPEEDS + N_TORQUES];
    static P(result_t) r;
    double out[3];
    while (fread(in, sizeof in, 1, stdin) == 1) {
        const int verdict = (int)P(evaluate)((P(state_t))(int)in[0], &in[1], &in[1 + N_SPEEDS], &r);
        out[0] = verdict;
        fwrite(out, sizeof out[0], 1, stdout);
        fwrite(r.speed, sizeof r.speed, 1, stdout);
        fwrite(r.torque, sizeof r.torque, 1, stdout);
        fwrite(r.shift_torque, sizeof r.shift_torque, 1, stdout);
        fwrite(r.mesh_loss, sizeof r.mesh_loss, 1, stdout);
        fwrite(r.drag_loss, sizeof r.drag_loss, 1, stdout);
        out[0] = r.loss;
        out[1] = r.power_in;
        out[2] = r.efficiency;
        fwrite(out, sizeof out, 1, stdout);
    }
    return 0;
}
