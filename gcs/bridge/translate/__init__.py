"""What a client's MAVLink message asks for, in the operators' words: see `translate.meaning_of`."""
