/* Calls the S-function that is included before: state, speeds and torques of one point on standard input, the first
   four outputs on standard output. */
#include <stdio.h>

int main(void)
{
    static real_T room[2][8][256];
    static SimStruct S;
    int k;
    mdlInitializeSizes(&S);
    mdlInitializeSampleTimes(&S);
    for (k = 0; k < 8; k++) {
        S.in[k] = room[0][k];
        S.out[k] = room[1][k];
    }
    for (k = 0; k < S.inputs; k++) {
        if (fread(S.in[k], sizeof(real_T), (size_t)S.width_in[k], stdin) != (size_t)S.width_in[k]) {
            return 1;
        }
    }
    mdlOutputs(&S, 0);
    for (k = 0; k < S.outputs; k++) {
        fwrite(S.out[k], sizeof(real_T), (size_t)S.width_out[k], stdout);
    }
    mdlTerminate(&S);
    return 0;
}
